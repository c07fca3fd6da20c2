# shellcheck shell=bash disable=SC2034,SC2154  # the parts share variables
# The machine that gpu-check runs on.

# value_of NAME FILE: what follows NAME in the first line of FILE that begins with it.
value_of() {
  local line
  [ ! -r "$2" ] || while IFS= read -r line; do
    [[ $line =~ ^"$1"[[:space:]:]+(.*)$ ]] && {
      printf '%s' "${BASH_REMATCH[1]}"
      return
    }
  done <"$2"
  printf 'not known'
}

# describe_gpus: what nvidia-smi says of each GPU at this moment, clocks among it.
describe_gpus() {
  local query=name,driver_version,memory.total,power.limit,clocks.current.sm,clocks.current.memory,clocks.max.sm,clocks.max.memory
  local names=() values=() objects=() lines=() line members i
  IFS=, read -r -a names <<<"$query"
  mapfile -t lines <<<"$(timeout 20 nvidia-smi --query-gpu="$query" --format=csv,noheader 2>/dev/null)"
  for line in "${lines[@]}"; do
    [ -n "$line" ] || continue
    IFS=, read -r -a values <<<"$line"
    members=()
    for i in "${!names[@]}"; do members+=("${names[i]//./_}" "$(json_string "${values[i]# }")"); done
    objects+=("$(json_object "${members[@]}")")
  done
  if [ ${#objects[@]} -gt 0 ]; then json_array "${objects[@]}"; else json_string "not known"; fi
}

describe_machine() {
  json_object processor "$(json_string "$(value_of 'model name' /proc/cpuinfo)")" processors "$(nproc)" \
    kernel "$(json_string "$(uname -sr)")"
}

# tool NAME: its path, from the PATH or from where CUDA's toolkit is installed; fails where it is not there.
tool() {
  local path
  path=$(command -v "$1" || command -v "/usr/local/cuda/bin/$1") && printf '%s' "$path"
}
