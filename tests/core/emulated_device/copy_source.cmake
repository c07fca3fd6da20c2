# cmake -DSOURCE=FOLDER -DCOPIES=FOLDER -DFILE=PATH -P copy_source.cmake: a source of core as the software device compiles it.
get_filename_component(here ${CMAKE_SCRIPT_MODE_FILE} DIRECTORY)
file(READ ${SOURCE}/${FILE} text)

# Shared memory belongs to a block, for which C++ has no storage: its declarations, in lines of their own, become calls.
string(REGEX REPLACE "__shared__ ([^;\n]*[^ ;\n]) ([a-z_]+)((\\[[^;\n]*\\])?);"
  "auto& \\2 = emulated_device::shared<\\1\\3>();" text "${text}")

function(plant fault file right wrong)
  if(NOT file STREQUAL FILE)
    return()
  endif()
  string(FIND "${text}" "${right}" first)
  string(FIND "${text}" "${right}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "The fault ${fault} has no single place in core/${file}: in faults.cmake, give it the text as it is there now:\n${right}")
  endif()
  string(REGEX REPLACE "FAULTY\\(([a-z_]+)\\)" "(emulated_device::fault == emulated_device::Fault::\\1)" wrong "${wrong}")
  string(REPLACE "${right}" "${wrong}" text "${text}")
  set(text "${text}" PARENT_SCOPE)
endfunction()
include(${here}/faults.cmake)
file(WRITE ${COPIES}/${FILE} "${text}")
