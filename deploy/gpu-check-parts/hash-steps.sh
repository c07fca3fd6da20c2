# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# mesh_sha256 of CPU and GPU, through the command line.

# text_values FILE NAME: the string values of that name, in the array `values`.
text_values() {
  local line
  values=()
  while IFS= read -r line; do
    if [[ $line =~ ^[[:space:]]*\"$2\":\ \"([^\"]*)\",?$ ]]; then values+=("${BASH_REMATCH[1]}"); fi
  done <"$1"
}

# compare_hashes NAME FOLDER RADIUS OPTION...: every frame in FOLDER on both backends.
compare_hashes() {
  local name="hashes, $1" folder=$2 radius=$3 log=$work/hashes.log passed=0 total=0 detail='' verdict=failed
  local backend values=() used=() hashes=() i
  shift 3
  local command=("$bin/meniscus" reconstruct "$folder/frame_{}.vtk" --start 0 --end $((frames - 1)) --particle-radius "$radius" "$@")
  for backend in cpu cuda; do
    rm -f "$work/$backend.json"
    seconds_left "$step_end"
    run "$log" "$answer" ignore_line "${command[@]}" --backend "$backend" --stats "$work/$backend.json"
    {
      echo "$name: $backend"
      cat "$log"
    } >>"$out/hashes.log"
    total=$((total + milliseconds))
    if [ "$cut_off" = yes ]; then
      verdict='cut off'
      break
    elif [ "$exit_code" != 0 ]; then
      detail="$backend, $(why_it_ended "$log")"
      break
    fi
    text_values "$work/$backend.json" backend
    used=("${values[@]}")
    text_values "$work/$backend.json" mesh_sha256
    for ((i = 0; i < frames; ++i)); do
      [ "${used[i]:-}" = "$backend" ] || detail="frame $i was not reconstructed by $backend"
      if [ "$backend" = cpu ]; then
        hashes[i]=${values[i]:-}
      elif [[ -n ${hashes[i]} && ${values[i]:-} = "${hashes[i]}" ]]; then
        passed=$((passed + 1))
      else
        detail=${detail:-frame $i differs}
      fi
    done
  done
  [[ $passed != "$frames" || -n $detail ]] || verdict=passed
  record "$name" "$verdict" "$passed" "$([ "$verdict" = 'cut off' ] && echo 0 || echo $((frames - passed)))" 0 "$total" \
    "meniscus reconstruct FRAMES --particle-radius $radius $*, --backend cpu and --backend cuda" "$detail"
}

step_hashes() {
  local water flags mode field edge_points radius folder command
  : >"$out/hashes.log"
  for water in uniform adaptive; do
    flags=()
    [ $water = uniform ] || flags=(--adaptive)
    folder=$work/$water command=("$bin/meniscus" simulate --scene dam-break --particles 16000 --frames "$frames" "${flags[@]}")
    seconds_left "$step_end"
    run "$out/simulate.log" "$answer" ignore_line "${command[@]}" --backend cpu --particles-out "$folder"
    radius=$(value_of 'particle radius' "$out/simulate.log")
    if [ "$exit_code" != 0 ] || [ "$radius" = 'not known' ]; then
      record "hashes, $water SPH" "$([ "$cut_off" = yes ] && echo 'cut off' || echo failed)" 0 "$frames" 0 "$milliseconds" \
        "${command[*]}" "$(why_it_ended "$out/simulate.log")"
      continue
    fi
    for mode in "--mode uniform" "--mode adaptive --criterion curvature" "--mode adaptive --criterion count"; do
      for field in smooth color density; do
        for edge_points in interpolate bisect; do
          # shellcheck disable=SC2086  # a mode is several words
          compare_hashes "$water SPH, $mode, $field, $edge_points" "$folder" "$radius" $mode --field $field --edge-points $edge_points
        done
      done
    done
    compare_hashes "$water SPH, 16-bit positions" "$folder" "$radius" --positions uint16
    rm -rf "$folder"
  done
}
