# Installs to a fresh prefix, moves that, then builds the consumer and the installed examples against it, and runs them.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
file(RENAME ${WORK}/prefix ${WORK}/moved)
foreach(license LICENSE copyright)
  if(NOT EXISTS ${WORK}/moved/share/doc/meniscus/${license})
    message(FATAL_ERROR "the installed folder lacks share/doc/meniscus/${license}")
  endif()
endforeach()
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIGURATION}
    -DCMAKE_PREFIX_PATH=${WORK}/moved -DEXAMPLES=${WORK}/moved/share/doc/libmeniscus-dev/examples
    "-DCMAKE_C_FLAGS=${FLAGS}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
run(${WORK}/build/consumer_c)
run(${WORK}/build/examples/in_process)
run(${WORK}/build/examples/in_process_c)
