# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# Steps that ask whether the GPU is right: tests, comparisons, sanitizers. A case that fails runs again in other ways, which
# narrow the fault down.

failed_cases_again=2 # of a step
seconds_per_case_again=30

# ---- GoogleTest

see_test_line() {
  if [[ $1 =~ ^\[\ RUN\ +\]\ ([^ ]+) ]]; then
    running_test=${BASH_REMATCH[1]}
  elif [[ $1 =~ ^\[\ +(OK|FAILED|SKIPPED)\ +\]\ ([^ ]+)\ \(([0-9]+)\ ms\)$ ]]; then
    [ "${BASH_REMATCH[1]}" != FAILED ] || failed_tests+=("${BASH_REMATCH[2]}")
    running_test=
    add_row tests "$(json_object step "\"$step\"" test "\"${BASH_REMATCH[2]}\"" result "\"${BASH_REMATCH[1]}\"" \
      milliseconds "${BASH_REMATCH[3]}")"
  elif [[ $1 =~ ^\[\ +(PASSED|FAILED|SKIPPED)\ +\]\ ([0-9]+)\ test ]]; then
    case ${BASH_REMATCH[1]} in
    PASSED) passed=${BASH_REMATCH[2]} ;;
    FAILED) failed=${BASH_REMATCH[2]} ;;
    SKIPPED) skipped=${BASH_REMATCH[2]} ;;
    esac
  fi
}

# run_tests NAME FILTER [COMMAND...]: the tests of cuda_test that FILTER picks, under COMMAND.
run_tests() {
  local name=$1 filter=$2 passed=0 failed=0 skipped=0 verdict=failed detail='' running_test='' failed_tests=()
  shift 2
  local command=("$@" "$bin/cuda_test" "--gtest_filter=$filter") log=$out/$name.log
  seconds_left "$step_end"
  run "$log" "$answer" see_test_line "${command[@]}"
  if [ "$cut_off" = yes ]; then
    verdict='cut off' detail="after ${#failed_tests[@]} failures${running_test:+, in $running_test}"
    [ ${#failed_tests[@]} = 0 ] || verdict=failed failed=${#failed_tests[@]}
  elif [ "$exit_code" != 0 ]; then
    detail=$(why_it_ended "$log")${running_test:+ (in $running_test)}
  elif [ "$passed" = 0 ]; then
    detail="no test has run"
  elif [ "$skipped" = 0 ]; then
    verdict=passed
  fi
  record "$name" "$verdict" "$passed" "$failed" "$skipped" "$milliseconds" "${command[*]}" "$detail"
  # A test in which the program crashes or hangs has no line of its own.
  if [ -n "$running_test" ]; then failed_tests+=("$running_test"); fi
  [ $# -gt 0 ] || tests_again
}

tests_again() {
  local test
  for test in "${failed_tests[@]:0:failed_cases_again}"; do
    case_again "$test" "$bin/cuda_test" "--gtest_filter=$test" -- "$bin/cuda_test" "--gtest_filter=$test"
  done
}

# case_again NAME COMMAND... -- SMALL_COMMAND...: a case that has failed, once more without graphs, with guarded arrays, and
# the small command, which is to show the same, under memcheck.
case_again() {
  local name=$1 command=() sanitizer way
  shift
  while [ "$1" != -- ]; do
    command+=("$1")
    shift
  done
  shift
  for way in MENISCUS_NO_GRAPH=1 MENISCUS_DEVICE_ARRAYS=guarded; do once_more "$name" "$way" env "$way" "${command[@]}"; done
  if sanitizer=$(tool compute-sanitizer); then
    once_more "$name" memcheck env MENISCUS_DEVICE_ARRAYS=separate "$sanitizer" --tool memcheck --error-exitcode 86 "$@"
  else
    add_row again "$(json_object case "$(json_string "$name")" way '"memcheck"' result '"not run"' \
      detail '"compute-sanitizer is not installed"')"
  fi
}

# once_more NAME WAY COMMAND...
once_more() {
  local name=$1 way=$2 log detail='' result=failed
  shift 2
  if [ "$again_milliseconds" -lt 1000 ]; then
    add_row again "$(json_object case "$(json_string "$name")" way "\"$way\"" result '"not run"' \
      detail '"a quarter of all time went by with what failed"')"
    return
  fi
  again_count=$((again_count + 1))
  log=$out/again-$again_count.log
  seconds_left "$all_end"
  [ "$answer" -lt "$seconds_per_case_again" ] || answer=$seconds_per_case_again
  [ "$answer" -lt $((again_milliseconds / 1000)) ] || answer=$((again_milliseconds / 1000))
  run "$log" "$answer" ignore_line "$@"
  again_milliseconds=$((again_milliseconds - milliseconds))
  if [ "$exit_code" = 0 ]; then
    result=passed
  else
    [ "$cut_off" = no ] || result='cut off'
    detail=$(why_it_ended "$log")
  fi
  echo "         again, $way: $result: $name${detail:+ ($detail)}"
  add_row again "$(json_object case "$(json_string "$name")" way "\"$way\"" result "\"$result\"" exit_code "$exit_code" \
    log "\"${log##*/}\"" detail "$(json_string "$detail")")"
}

# ---- CPU = CUDA in one process

count_comparison() {
  local result
  cell result
  result=$answer
  case $result in
  same) passed=$((passed + 1)) ;;
  left_out) skipped=$((skipped + 1)) ;;
  *)
    failed=$((failed + 1))
    cell particles
    local particles=$answer flag case_name=$answer flags=''
    for flag in cell_size=--cell-sizes field=--fields mode=--modes water=--waters; do
      cell "${flag%%=*}"
      flags+=" ${flag#*=} $answer" case_name+=" $answer"
    done
    cell run
    if [[ $answer = thread* ]]; then flags+=' --threads 4'; else flags+=' --threads 1'; fi
    # Its frames are one case.
    [[ " ${different_cases[*]} " == *"$particles|$flags|"* ]] || different_cases+=("$particles|$flags|$case_name $answer")
    ;;
  esac
}

see_row() { take_rows; }

# compare_meshes NAME FLAG...: meniscus-bench same.
compare_meshes() {
  local name=$1 passed=0 failed=0 skipped=0 verdict=failed detail='' different_cases=() entry particles flags case_name words
  shift
  local log=$out/$name.log folder=$out/$name
  seconds_left "$step_end"
  local command=("$bin/meniscus-bench" same "$@" --budget "$((answer > 3 ? answer - 3 : answer))" --out "$folder")
  follow same "\"step\": \"$name\"" "$folder/same.csv" count_comparison
  run "$log" "$answer" see_row "${command[@]}"
  take_rows
  if [ "$failed" -gt 0 ]; then
    detail="$failed comparisons differ or failed: see the rows of step $name"
  elif [ "$cut_off" = yes ]; then
    verdict='cut off'
  elif [ "$exit_code" != 0 ]; then
    detail=$(why_it_ended "$log")
  elif [ "$passed" = 0 ]; then
    detail="nothing was compared"
    [ "$skipped" = 0 ] || verdict='cut off'
  elif [ "$skipped" -gt 0 ]; then
    verdict='cut off' detail="$skipped comparisons were left out: the time was up"
  else
    verdict=passed
  fi
  [ "$verdict" != failed ] || [ "$failed" -gt 0 ] || failed=1
  record "$name" "$verdict" "$passed" "$failed" "$skipped" "$milliseconds" "${command[*]}" "$detail"
  for entry in "${different_cases[@]:0:failed_cases_again}"; do
    IFS='|' read -r particles flags case_name <<<"$entry"
    read -r -a words <<<"$flags --out $work/again"
    case_again "$case_name" "$bin/meniscus-bench" same --particles "$particles" "${words[@]}" -- \
      "$bin/meniscus-bench" same --particles $((million / 64)) "${words[@]}"
  done
}

step_tests() { run_tests tests '-*ThousandFrames*'; }
# The largest first: what a smaller one takes says little of a larger one, for which there then seems to be no time.
step_same() { compare_meshes same --particles "$million" $((million / 4)) $((million / 64)) --threads 1; }
step_same-large() { compare_meshes same-large --particles $((4 * million)) --cell-sizes 1 --fields smooth --replays 1 --threads 1; }
step_same-huge() { compare_meshes same-huge --particles $((16 * million)) --cell-sizes 1 --fields smooth --waters splashing --replays 1 --threads 1; }
step_same-threads() { compare_meshes same-threads --particles $((million / 4)) --cell-sizes 1 --fields smooth --modes adaptive --replays 0 --threads 4; }
step_guarded() { run_tests guarded '-*ThousandFrames*:*StageOfAWarmFrame*' env MENISCUS_DEVICE_ARRAYS=guarded; }
step_no-graph() { run_tests no-graph '-*ThousandFrames*' env MENISCUS_NO_GRAPH=1; }
step_thousand-frames() { run_tests thousand-frames '*ThousandFrames*'; }

count_check() {
  cell result
  if [ "$answer" = same ]; then passed=$((passed + 1)); elif [ "$answer" != left_out ]; then failed=$((failed + 1)); else skipped=$((skipped + 1)); fi
}

step_exact() {
  local passed=0 failed=0 skipped=0 verdict=failed detail='' log=$out/exact.log
  seconds_left "$step_end"
  # The host's part of larger sorts, on one thread, takes longer than all roots.
  local command=("$bin/meniscus-bench" exact --elements 1000000 --out "$out/exact")
  follow exact '' "$out/exact/exact.csv" count_check
  run "$log" "$answer" see_row "${command[@]}"
  take_rows
  if [ "$failed" -gt 0 ] || { [ "$exit_code" != 0 ] && [ "$cut_off" = no ]; }; then
    detail=$(why_it_ended "$log")
  elif [ "$cut_off" = yes ] || [ "$skipped" -gt 0 ]; then
    verdict='cut off'
  elif [ "$passed" = 0 ]; then
    detail="nothing was checked"
  else
    verdict=passed
  fi
  [ "$verdict" != failed ] || [ "$failed" -gt 0 ] || failed=1
  record exact "$verdict" "$passed" "$failed" "$skipped" "$milliseconds" "${command[*]}" "$detail"
}

# ---- compute-sanitizer

# sanitize TOOL NAME FILTER
sanitize() {
  local sanitizer arrays=together
  if ! sanitizer=$(tool compute-sanitizer); then
    record "$2" "not run" 0 0 0 0 "compute-sanitizer --tool $1" "compute-sanitizer is not installed"
    return
  fi
  # An overrun within one allocation for all arrays is none to memcheck. (With separate arrays initcheck would report
  # scans, too, which read on to an array's capacity.)
  [ "$1" != memcheck ] || arrays=separate
  run_tests "$2" "$3" env MENISCUS_DEVICE_ARRAYS=$arrays "$sanitizer" --tool "$1" --error-exitcode 86
}

one_small_test='CudaSmall.GivesTheCpusMeshForParticleLevelsQuantizedPositionsAndDomains'
step_memcheck() { sanitize memcheck memcheck "$one_small_test"; }
step_racecheck() { sanitize racecheck racecheck "$one_small_test"; }
step_synccheck() { sanitize synccheck synccheck "$one_small_test"; }
step_sanitizers() {
  local each end=$step_end
  for each in 1 2 3 4; do
    now
    # Its share of what is left.
    step_end=$((answer + (end - answer) / (5 - each)))
    case $each in
    1) sanitize memcheck all-memcheck 'CudaSmall*' ;;
    2) sanitize racecheck all-racecheck 'CudaSmall*' ;;
    3) sanitize initcheck all-initcheck 'CudaSmall*' ;;
    4) sanitize synccheck all-synccheck 'CudaSmall*' ;;
    esac
  done
}
