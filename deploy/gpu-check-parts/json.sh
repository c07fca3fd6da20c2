# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# JSON and CSV, by hand: there may be nothing here that writes them. A function leaves its answer in `answer`, since a
# subshell for each of some thousand cells would take seconds.

# json_quote TEXT: a JSON string.
json_quote() {
  local text=${1//\\/\\\\}
  text=${text//\"/\\\"}
  text=${text//$'\n'/\\n}
  answer='"'${text//[^ -~]/?}'"'
}

json_string() {
  json_quote "$1"
  printf '%s' "$answer"
}

# json_object NAME VALUE...: the values are JSON already.
json_object() {
  local separator='' text=''
  while [ $# -gt 0 ]; do
    json_quote "$1"
    text+="$separator$answer: $2"
    separator=', '
    shift 2
  done
  printf '{%s}' "$text"
}

# json_array VALUE...
json_array() {
  local separator='' text='' value
  for value in "$@"; do
    text+="$separator"$'\n'"    $value"
    separator=,
  done
  printf '[%s\n  ]' "$text"
}

# csv_cells LINE: its cells, in the array `cells`. Cells with commas stand in double quotes.
csv_cells() {
  local rest=$1
  cells=()
  while :; do
    if [[ $rest =~ ^\"([^\"]*)\"(,(.*))?$ ]] || [[ $rest =~ ^([^,]*)(,(.*))?$ ]]; then
      cells+=("${BASH_REMATCH[1]}")
      [ -n "${BASH_REMATCH[2]}" ] || return 0
      rest=${BASH_REMATCH[3]}
    else
      cells+=("$rest")
      return 0
    fi
  done
}

# json_row: the row of `columns` and `cells` as a JSON object, after the members of $1 (JSON without braces, may be empty).
json_row() {
  local text=$1 i cell
  for i in "${!columns[@]}"; do
    json_quote "${columns[i]}"
    text+="${text:+, }$answer: "
    cell=${cells[i]:-}
    if [[ $cell =~ ^-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?$ ]]; then
      text+=$cell
    else
      json_quote "$cell"
      text+=$answer
    fi
  done
  answer="{$text}"
}
