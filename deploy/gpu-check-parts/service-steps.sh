# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# Steps beside which the GPU is seen: the service around it, and splashsurf.

# The server goes when the load generator has its figures.
step_service() {
  local program address=unix:$work/meniscusd line output verdict=failed detail='' ready=no i
  for program in meniscusd meniscus-load; do
    [ -x "$bin/$program" ] || {
      record service "not run" 0 0 0 0 "bin/$program" "$program is not here"
      return
    }
  done
  local command=("$bin/meniscus-load" --server "$address" --simulators 4 --particles 16000 --seconds 20 --rate 20 --json "$out/service.json")
  : >"$out/meniscusd.log"
  seconds_left "$step_end"
  # 0 would be no limit to timeout.
  exec {output}< <(exec timeout --kill-after=15 $((answer > 0 ? answer : 1)) "$bin/meniscusd" --listen "$address" --backend cuda 2>&1)
  server=$!
  milliseconds=0
  while IFS= read -r -u "$output" line; do
    printf '%s\n' "$line" >>"$out/meniscusd.log"
    if [[ $line == *"listening on"* ]]; then
      ready=yes
      break
    fi
  done
  if [ $ready = yes ]; then
    # Its output from now on goes to its log, so that it never waits for a reader.
    cat <&"$output" >>"$out/meniscusd.log" &
    seconds_left "$step_end"
    run "$out/service.log" "$answer" ignore_line "${command[@]}"
    if [ "$cut_off" = yes ]; then
      verdict='cut off'
    elif [ "$exit_code" != 0 ]; then
      detail=$(why_it_ended "$out/service.log")
    elif [ ! -s "$out/service.json" ]; then
      detail="it wrote no figures"
    else
      verdict=passed
      add_row service "$(<"$out/service.json")"
    fi
  else
    detail="meniscusd did not listen: $(last_line "$out/meniscusd.log")"
  fi
  kill "$server" 2>/dev/null
  exec {output}<&-
  # The next step has the GPU to itself.
  for ((i = 0; i < 160; ++i)); do
    kill -0 "$server" 2>/dev/null || break
    sleep 0.1
  done
  server=
  record service "$verdict" 0 '' 0 "$milliseconds" "${command[*]}" "$detail"
}

# see_splashsurf_line: splashsurf logs when it begins with the particles, and when it has the mesh.
see_splashsurf_line() {
  [[ $1 =~ ^\[([0-9]+):([0-9]+):([0-9]+)\.([0-9]{3}).*(Starting classification of particles|Global mesh has) ]] || return 0
  local at=$((((10#${BASH_REMATCH[1]} * 60 + 10#${BASH_REMATCH[2]}) * 60 + 10#${BASH_REMATCH[3]}) * 1000 + 10#${BASH_REMATCH[4]}))
  if [ "${BASH_REMATCH[5]}" = "Global mesh has" ]; then
    took=$(((at - began + 86400000) % 86400000))
  else
    began=$at
  fi
}

# The second of two frames in one process counts, as ours are warm.
step_splashsurf() {
  local splashsurf verdict=failed detail='' log=$out/splashsurf.log began=0 took=-1 i
  if ! splashsurf=$(tool splashsurf); then
    record splashsurf "not run" 0 0 0 0 splashsurf "splashsurf is not installed: put its program on the PATH"
    return
  fi
  seconds_left "$step_end"
  run "$log" "$answer" ignore_line "$bin/meniscus-bench" scaling --max-particles "$million" --write-water "$work/water_1.vtk"
  local command=("$splashsurf" reconstruct "$work/water_{}.vtk" -o "$work/splashsurf_{}.ply" -r 0.025 -l 2 -c 1 -t 0.6 -n "$(nproc)")
  if [ "$exit_code" = 0 ] && cp "$work/water_1.vtk" "$work/water_2.vtk"; then
    seconds_left "$step_end"
    run "$log" "$answer" see_splashsurf_line "${command[@]}"
  fi
  rm -f "$work"/water_*.vtk "$work"/splashsurf_*.ply
  if [ "$cut_off" = yes ]; then
    verdict='cut off'
  elif [ "$exit_code" != 0 ]; then
    detail=$(why_it_ended "$log")
  elif [ $took -lt 0 ]; then
    detail="its log does not say how long it took"
  else
    verdict=passed
    printf -v i '%d.%03d' $((took / 1000)) $((took % 1000))
    mkdir -p "$out/measured"
    json_object seconds "$i" threads "$(nproc)" particles "$million" cell_size 1.0 field '"color"' >"$out/measured/splashsurf.json"
    add_row splashsurf "$(<"$out/measured/splashsurf.json")"
    judge_goals "$out/measured"
  fi
  record splashsurf "$verdict" 0 '' 0 "$milliseconds" "${command[*]}" "$detail"
}
