# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# The findings: steps, and tables of rows. results.json is written anew after each step and after each row, so that a
# run that is killed leaves all of them.

steps=()          # JSON objects
declare -A tables # by name: JSON objects, with commas between them
table_order=()
device='"not known"' gpus='"not known"' gpus_after='"not run"' goals=null # JSON
worst=passed                                                              # of passed, cut off, failed

# add_row TABLE OBJECT
add_row() {
  [ -n "${tables[$1]+there}" ] || table_order+=("$1")
  tables[$1]+="${tables[$1]:+,}"$'\n'"      $2"
  write_results incomplete
}

# write_results RESULT
write_results() {
  local name each separator='' written_tables='' written_steps=''
  for each in "${steps[@]}"; do
    written_steps+="$separator"$'\n'"    $each"
    separator=,
  done
  separator=
  for name in "${table_order[@]}"; do
    written_tables+="$separator"$'\n'"    \"$name\": [${tables[$name]}"$'\n'"    ]"
    separator=,
  done
  cat >"$out/results.json.part" <<JSON && mv "$out/results.json.part" "$out/results.json"
{
  "result": "$1",
  "version": $version,
  "commit": $commit_json,
  "started": "$started",
  "machine": $machine,
  "device": $device,
  "gpus": $gpus,
  "gpus_after": $gpus_after,
  "seconds_allowed": $seconds_in_all,
  "steps": [$written_steps
  ],
  "goals": $goals,
  "tables": {$written_tables
  }
}
JSON
}

# record NAME RESULT PASSED FAILED SKIPPED MILLISECONDS COMMAND DETAIL. RESULT: passed, failed, cut off (its time was up),
# left out (there was no time for it), not run (something that it needs is not there). FAILED may be
# empty: 1 for what has failed.
record() {
  local seconds failures=$4 columns cells
  [ -n "$failures" ] || { if [ "$2" = failed ]; then failures=1; else failures=0; fi; }
  printf -v seconds '%d.%03d' $(($6 / 1000)) $(($6 % 1000))
  columns=(step name result passed failed skipped seconds command detail)
  cells=("$step" "$1" "$2" "$3" "$failures" "$5" "$seconds" "${7//"$here/"/}" "$8")
  json_row ''
  steps+=("$answer")
  printf '%-8s %s: %s passed, %s failed, %s skipped, %s s%s\n' "$2" "$1" "$3" "$failures" "$5" "$seconds" "${8:+ ($8)}"
  case $2 in
  failed) worst=failed ;;
  'cut off' | 'left out') [ "$worst" = failed ] || worst='cut off' ;;
  esac
  write_results incomplete
}
