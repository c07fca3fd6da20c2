# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# Commands with a limit of time, whose lines are looked at as they come.

running=   # process id of the command that runs
server=    # process id of the service beside it
step_end=0 # when the step's time is up, microseconds
all_end=0  # when all time is up

now() { answer=${EPOCHREALTIME/./}; }

# seconds_left END: whole seconds until then, at least 0; never beyond the end of all time.
seconds_left() {
  local end=$(($1 < all_end ? $1 : all_end))
  now
  answer=$((end > answer ? (end - answer) / 1000000 : 0))
}

ignore_line() { :; }
ignore_row() { :; }

# run LOG SECONDS ON_LINE COMMAND...: ON_LINE is called with each line of its output. Leaves exit_code, the time it took in
# milliseconds, and whether it was cut_off, in variables of these names. The command is in a process group of its own, which
# ends as a whole.
run() {
  local log=$1 seconds=$2 on_line=$3 line begin output
  shift 3
  now
  begin=$answer cut_off=no
  : >"$log"
  if [ "$seconds" -lt 1 ]; then
    exit_code=124 milliseconds=0 cut_off=yes
    return
  fi
  if [ "$on_line" = ignore_line ]; then
    # Machine code has more lines than could be read here in time.
    timeout --kill-after=5 "$seconds" "$@" >"$log" 2>&1 </dev/null &
    running=$!
    wait "$running"
    exit_code=$?
  else
    exec {output}< <(exec timeout --kill-after=5 "$seconds" "$@" 2>&1)
    running=$!
    while IFS= read -r -u "$output" line || [ -n "$line" ]; do
      printf '%s\n' "$line" >>"$log"
      "$on_line" "$line"
    done
    wait "$running"
    exit_code=$?
    exec {output}<&-
  fi
  running=
  now
  milliseconds=$(((answer - begin) / 1000))
  # A command that ends itself with 124 does so earlier.
  if [ $milliseconds -ge $((1000 * seconds)) ] && { [ $exit_code = 124 ] || [ $exit_code = 137 ]; }; then cut_off=yes; fi
}

last_line() { tail -n 1 "$1"; }

# why_it_ended LOG: exit code and last words.
why_it_ended() { printf 'exit code %s: %s' "$exit_code" "$(last_line "$1")"; }

# follow TABLE MEMBERS FILE ON_ROW: from now on take_rows adds the rows of FILE, a CSV that a command is about to write, to TABLE,
# each with MEMBERS (JSON members without braces) in front. ON_ROW is called with `columns` and `cells` set.
follow() {
  followed_table=$1 followed_members=$2 followed_file=$3 on_row=$4 columns=() rows_taken=0
  rm -f "$followed_file"
}

# take_rows: those that are in the file since it was called last; called for each line that the command prints.
take_rows() {
  local lines=() line
  [ -r "$followed_file" ] || return 0
  mapfile -s "$rows_taken" lines <"$followed_file"
  for line in "${lines[@]}"; do
    [[ $line == *$'\n' ]] || break # still being written
    rows_taken=$((rows_taken + 1))
    csv_cells "${line%$'\n'}"
    if [ ${#columns[@]} = 0 ]; then
      columns=("${cells[@]}")
      continue
    fi
    json_row "$followed_members"
    add_row "$followed_table" "$answer"
    "$on_row"
  done
}

# cell NAME: of the row at hand.
cell() {
  local i
  answer=
  for i in "${!columns[@]}"; do
    if [ "${columns[i]}" = "$1" ]; then
      answer=${cells[i]:-}
      return
    fi
  done
}
