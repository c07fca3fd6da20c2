# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# Steps that measure, beside what was predicted.

# million: the particles of the frames that are timed, a million but for --particles.

# ---- Whole frames

compare_frame() {
  local name case_name='' milliseconds
  for name in particles water cell_size field mode; do
    cell $name
    case_name+="${case_name:+ }${answer%.0}"
  done
  cell reconstruction_seconds
  [ -n "$answer" ] || return 0
  printf -v milliseconds '%.3f' "${answer}e3"
  compare_times "$case_name" reconstruction "$milliseconds"
}

# measure TABLE ON_ROW BENCHMARK FLAG...: a command of meniscus-bench that leaves rows. Its results go to FOLDER/measured,
# where the goals are judged, or to the folder measured_in.
measure() {
  local table=$1 on_row=$2 benchmark=$3 folder=${measured_in:-$out/measured} verdict=failed detail='' rows log
  shift 3
  log=$out/$step-$benchmark.log
  local command=("$bin/meniscus-bench" "$benchmark" "$@" --out "$folder")
  follow "$table" "\"step\": \"$step\"" "$folder/$benchmark.csv" "$on_row"
  rm -f "$folder/$benchmark.json" # of an earlier run: no goal is judged by it
  seconds_left "$step_end"
  run "$log" "$answer" see_row env MENISCUS_COMMIT="$commit" "${command[@]}"
  take_rows
  rows=$((rows_taken > 0 ? rows_taken - 1 : 0))
  if [ "$cut_off" = yes ]; then
    verdict='cut off' detail="after $rows rows"
  elif [ "$exit_code" != 0 ]; then
    detail=$(why_it_ended "$log")
  elif [ "$rows" = 0 ]; then
    detail="it measured nothing"
  else
    verdict=passed
  fi
  gpus_after=$(describe_gpus)
  record "$step" "$verdict" "$rows" '' 0 "$milliseconds" "${command[*]}" "$detail"
}

# judge_goals FOLDER: what is to be reached beside what the results in FOLDER say; a goal that is missed is no failure.
judge_goals() {
  local command=("$bin/meniscus-bench" goals --out "$1")
  run "$out/goals.log" 60 ignore_line "${command[@]}"
  if [ "$exit_code" = 0 ]; then
    goals=$(cat "$1/goals.json")
  else
    record goals failed 0 1 0 "$milliseconds" "${command[*]}" "$(why_it_ended "$out/goals.log")"
  fi
}

step_times() {
  measure times compare_frame scaling --backend cuda --min-particles "$million" --max-particles "$million" --fields smooth color \
    --cell-sizes 1 --repeats 20 --seconds-per-case 2
  judge_goals "$out/measured"
}

# Into folders of their own: the goals are those of a GPU, of the step `times`.
step_scaling() {
  local measured_in=$out/measured-sizes
  measure scaling compare_frame scaling --backend cuda --max-particles $((4 * million)) --seconds-per-case 2
}
step_cpu() {
  local measured_in=$out/measured-cpu
  measure cpu ignore_row scaling --backend cpu --threads 0 --min-particles "$million" --max-particles "$million" \
    --fields smooth color --cell-sizes 1 --seconds-per-case 5
}

step_experiment() {
  measure experiment ignore_row experiment --backend cuda --frames 30 --frame-seconds 0.08 --repeats 5
  judge_goals "$out/measured"
}

step_encoding() { measure encoding ignore_row encoding --particles "$million" --cell-size 1 --speed 10 --repeats 1; }

# ---- Kernels

# One row for each launch of a frame; a kernel's time is the sum over its launches.
add_launch() {
  local kernel microseconds
  cell kernel
  kernel=$answer
  cell median_us
  [[ $answer =~ ^[0-9] ]] || return 0 # gaps may be negative
  micro "$answer"
  microseconds=$answer
  launches[$kernel]=$((${launches[$kernel]:-0} + microseconds))
  cell model_us
  if [[ $answer =~ ^[0-9] ]]; then
    micro "$answer"
    modelled[$kernel]=$((${modelled[$kernel]:-0} + answer))
  fi
}

# as_milliseconds PICOSECONDS
as_milliseconds() { printf -v answer '%d.%06d' $(($1 / 1000000000)) $(($1 % 1000000000 / 1000)); }

# measure_kernels PARTICLES WATER CELL_SIZE FIELD MODE
measure_kernels() {
  local case_name="$*" verdict=failed detail='' kernel log folder measured model
  local -A launches=() modelled=()
  folder=$out/kernels/${case_name// /-} log=$out/kernels-${case_name// /-}.log
  local command=("$bin/meniscus-bench" kernels --particles "$1" --water "$2" --cell-size "$3" --field "$4" --mode "$5" --out "$folder")
  follow kernels "\"step\": \"$step\", \"case\": \"$case_name\"" "$folder/kernels.csv" add_launch
  seconds_left "$step_end"
  run "$log" "$answer" see_row "${command[@]}"
  take_rows
  for kernel in "${!launches[@]}"; do
    as_milliseconds "${launches[$kernel]}"
    measured=$answer model=
    if [ -n "${modelled[$kernel]:-}" ]; then
      as_milliseconds "${modelled[$kernel]}"
      model=$answer
    fi
    compare_times "$case_name" "$kernel" "$measured" "$model"
  done
  if [ "$cut_off" = yes ]; then
    verdict='cut off' detail="after ${#launches[@]} kernels"
  elif [ "$exit_code" != 0 ]; then
    detail=$(why_it_ended "$log")
  elif [ ${#launches[@]} = 0 ]; then
    detail="it measured nothing"
  else
    verdict=passed
  fi
  record "$step, $case_name" "$verdict" "${#launches[@]}" '' 0 "$milliseconds" \
    "${command[*]}" "$detail"
}

step_kernels() {
  local field mode
  for field in smooth color; do
    for mode in uniform adaptive; do measure_kernels "$million" splashing 1 $field $mode; done
  done
}

step_kernels-more() {
  local field mode
  for mode in uniform adaptive; do
    measure_kernels "$million" splashing 0.5 smooth $mode
    measure_kernels $((million / 64)) splashing 1 smooth $mode
    measure_kernels "$million" calm 1 smooth $mode
    measure_kernels $((4 * million)) splashing 1 smooth $mode
  done
}

# profile NAME CELL_SIZE KERNELS: Nsight Compute on the first launches of the kernels that match, in a warm frame.
profile() {
  local name=$1 ncu command log=$out/$1.log verdict=failed detail='' kernels rest=${3//[^|]/}
  kernels=$((2 * (${#rest} + 1)))
  command=(--set full --clock-control none -k "regex:$3" -c "$kernels" --profile-from-start off --force-overwrite -o "$out/$name"
    "$bin/meniscus-bench" kernels --particles "$million" --cell-size "$2" --repeats 1 --out "$work/profile")
  if ! ncu=$(tool ncu); then
    record "$name" "not run" 0 0 0 0 "ncu ${command[*]}" "ncu is not installed"
    return
  fi
  seconds_left "$step_end"
  run "$log" "$answer" ignore_line "$ncu" "${command[@]}"
  if [ "$cut_off" = yes ]; then
    verdict='cut off'
  elif [[ $(<"$log") == *ERR_NVGPUCTRPERM* ]]; then
    verdict='not run' detail="the driver gives its counters to root alone: run as root, or load it with NVreg_RestrictProfilingToAdminUsers=0"
  elif [ "$exit_code" != 0 ]; then
    detail=$(why_it_ended "$log")
  elif [ ! -s "$out/$name.ncu-rep" ]; then
    detail="it wrote no profile"
  else
    verdict=passed
  fi
  record "$name" "$verdict" 0 '' 0 "$milliseconds" "ncu ${command[*]}" "$detail"
}

most_of_the_time='sample_list|place_listed|emit_cells|settle_band|measure_band|mark_reached_cells|sample_base|sum_at_each_particle'
step_profile() { profile profile 1 'sample_list|place_listed|emit_cells'; }
step_profile-more() {
  profile profile-coarse 1 "$most_of_the_time"
  profile profile-fine 0.5 "$most_of_the_time"
}

step_code() {
  local cuobjdump verdict=failed detail='' flag=-sass
  if ! cuobjdump=$(tool cuobjdump); then
    record code "not run" 0 0 0 0 "cuobjdump -sass" "cuobjdump is not installed"
    return
  fi
  for flag in -res-usage -sass; do
    seconds_left "$step_end"
    run "$out/code$flag.txt" "$answer" ignore_line "$cuobjdump" $flag "$bin/meniscus-bench"
    [ "$exit_code" = 0 ] || break
  done
  if [ "$cut_off" = yes ]; then verdict='cut off'; elif [ "$exit_code" = 0 ]; then verdict=passed; else detail=$(why_it_ended "$out/code$flag.txt"); fi
  record code "$verdict" 0 '' 0 "$milliseconds" "cuobjdump $flag" "$detail"
}
