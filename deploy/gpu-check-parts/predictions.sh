# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# Measured times beside predicted ones. The predictions were written before any measurement: predictions.csv has
# milliseconds of a kernel, over all its launches in a frame, or of a whole `reconstruction`.

declare -A predicted # by "particles water cell_size field mode kernel": milliseconds

read_predictions() {
  local line cells=()
  while IFS= read -r line; do
    csv_cells "$line"
    [ "${cells[0]}" = particles ] || predicted["${cells[0]} ${cells[1]} ${cells[2]%.0} ${cells[3]} ${cells[4]} ${cells[5]}"]=${cells[6]}
  done <"$here/gpu-check-parts/predictions.csv"
}

# micro NUMBER: the number in millionths, as an integer.
micro() {
  printf -v answer '%.6f' "$1"
  answer=$((10#${answer/./}))
}

# compare_times CASE KERNEL MEASURED PREDICTED: a row of the table `comparison`, times in milliseconds; marked if one is more
# than twice the other. Without a PREDICTED, that of the predictions; without one there, nothing.
compare_times() {
  local key="$1 $2" expected=${4:-} measured wanted ratio verdict=''
  [ -n "$expected" ] || expected=${predicted[$key]:-${predicted["$1 ${2%%<*}"]:-}}
  [ -n "$expected" ] || return 0
  micro "$3"
  measured=$answer
  micro "$expected"
  wanted=$answer
  [ "$wanted" -gt 0 ] || return 0
  ratio=$((100 * measured / wanted))
  if [ $measured -gt $((2 * wanted)) ]; then verdict='more than twice'; fi
  if [ $((2 * measured)) -lt "$wanted" ]; then verdict='less than half'; fi
  [ -z "$verdict" ] || echo "!!       $1, $2: $3 ms, $verdict of the $expected ms that were predicted"
  add_row comparison "$(json_object case "$(json_string "$1")" kernel "$(json_string "$2")" predicted_milliseconds "$expected" \
    measured_milliseconds "$3" measured_over_predicted "$((ratio / 100)).$(printf '%02d' $((ratio % 100)))" \
    missed "\"$verdict\"")"
}
