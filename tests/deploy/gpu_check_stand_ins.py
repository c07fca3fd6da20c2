"""Programs that stand for those that gpu-check calls: bash, whose answers FAKE_* variables set."""

MENISCUS = r"""
backend= mode= stats= last=0 command=$1
while [ $# -gt 0 ]; do
  case $1 in --backend) backend=$2 ;; --mode) mode=$2 ;; --stats) stats=$2 ;; --end) last=$2 ;; esac
  shift
done
case $command in
  info)
    [ -z "${FAKE_REFUSAL:-}" ] || { echo "meniscus: the CUDA backend cannot be used: $FAKE_REFUSAL" >&2; exit 2; }
    echo 'version                0.1.0'
    echo "device                 ${FAKE_DEVICE:-Some GPU}"
    ;;
  simulate) echo 'particle radius 0.0125' ;;
  reconstruct)
    {
      echo '{ "frames": ['
      for ((i = 0; i <= last; ++i)); do
        printf -v hash '%064x' "$i"
        if [ "$backend" = cuda ]; then
          [ "${FAKE_WRONG_FRAME:-}" != "$i$mode" ] || hash=${hash//0/f}
          backend=${FAKE_BACKEND:-cuda}
        fi
        printf '    {\n      "backend": "%s",\n      "mesh_sha256": "%s"\n    }' "$backend" "$hash"
        [ "$i" = "$last" ] || echo ,
      done
      echo '] }'
    } >"$stats"
    ;;
esac
"""

CUDA_TEST = r"""
passed=${FAKE_PASSED:-7}
echo "$MENISCUS_NO_GRAPH $MENISCUS_DEVICE_ARRAYS $*" >>"${FAKE_ASKED:-/dev/null}"
echo "[==========] Running $passed tests from 2 test suites."
echo '[ RUN      ] Cuda.Fine'
echo '[       OK ] Cuda.Fine (12 ms)'
echo '[ RUN      ] Cuda.Some'
[ -z "${FAKE_CRASH:-}" ] || kill -SEGV $$
[ -z "${FAKE_HANGING_TEST:-}" ] || exec sleep 60
[ -n "${FAKE_FAILED:-}" ] && echo '[  FAILED  ] Cuda.Some (3 ms)' || echo '[       OK ] Cuda.Some (3 ms)'
echo "[  PASSED  ] $passed tests."
[ -z "${FAKE_SKIPPED:-}" ] || printf '[  SKIPPED ] %s tests, listed below:\n[  SKIPPED ] Cuda.Some\n' "$FAKE_SKIPPED"
[ -n "${FAKE_FAILED:-}" ] || exit 0
printf '[  FAILED  ] %s tests, listed below:\n[  FAILED  ] Cuda.Some\n' "$FAKE_FAILED"
exit 1
"""

MENISCUS_BENCH = r"""
name=$1 replays=1 out= particles= given="$*" graph=${MENISCUS_NO_GRAPH:-0} arrays=${MENISCUS_DEVICE_ARRAYS:-together}
while [ $# -gt 0 ]; do
  case $1 in --out) out=$2 ;; --particles) particles=$2 ;; esac
  shift
done
[ -z "${FAKE_ASKED:-}" ] || echo "$graph $arrays $given" >>"$FAKE_ASKED"
[ "${FAKE_BROKEN_BENCHMARK:-}" != "$name" ] || { echo 'out of "memory"' >&2; exit 1; }
mkdir -p "$out"
row() { echo "$1" >>"$out/$name.csv"; echo "$1"; }
hang() { [ "${FAKE_HANG:-}" != "$name" ] || { [ -z "${FAKE_FIFO:-}" ] || echo here >"$FAKE_FIFO"; exec sleep 60; }; }
rm -f "$out/$name.csv"
case $name in
  goals)
    [ -e "$out/scaling.json" ] && measured=7.5 || measured=null
    echo "[{\"goal\": \"8 ms\", \"measured\": $measured}]" >"$out/goals.json"
    ;;
  same)
    row particles,water,field,mode,cell_size,run,result,seconds,different,first_difference
    row "$particles,calm,smooth,uniform,1,frame 1,same,0.5,0,"
    hang
    result=${FAKE_MESHES:-same}
    # A difference with graphs alone.
    [ "$graph$result" != 1different ] || result=same
    row "$particles,splashing,smooth,uniform,1,frame 1,$result,0.5,0,vertex 7"
    row "$particles,splashing,smooth,uniform,1,frame 4 (graph),$result,0.5,0,vertex 7"
    [ "$result" != different ] || exit 1
    ;;
  exact)
    row check,n,run,result,different,first_difference
    row "root,4294967296,plain,${FAKE_ROOTS:-same},0,"
    [ -z "${FAKE_ROOTS:-}" ] || exit 1
    ;;
  kernels)
    row order,kernel,blocks,threads,cooperative,registers,shared_bytes,median_us,min_us
    row '0,"sample_list<4, false>",10,256,0,80,0,3000,2900'
    hang
    row '1,"sample_list<4, false>",10,256,0,80,0,500,490'
    row "2,emit_cells,10,256,0,80,0,${FAKE_EMIT:-1500},1400"
    row ',frame,,,,,,5600,5500'
    row ',gaps,,,,,,-3.5,-3'
    ;;
  scaling)
    case $given in *--write-water*) last=${given##*--write-water }; echo water >"${last%% *}"; exit 0 ;; esac
    ;;&
  *)
    row water,field,cell_size,mode,particles,reconstruction_seconds
    row "splashing,color,1.0,uniform,1024000,${FAKE_SECONDS:-0.012}"
    hang
    echo "{\"commit\": \"$MENISCUS_COMMIT\"}" >"$out/$name.json"
    ;;
esac
"""

NVIDIA_SMI = r"""
[ -z "${FAKE_NO_GPU:-}" ] || { echo 'No devices were found'; exit 6; }
if [ "$1" = -L ]; then
  echo 'GPU 0: Some GPU'
else
  echo 'Some "GPU", 580.1, 81559 MiB, 700.00 W, 345 MHz, 2619 MHz, 1980 MHz, 2619 MHz'
fi
"""

NCU = r"""
[ -z "${FAKE_NO_COUNTERS:-}" ] || { echo '==ERROR== ERR_NVGPUCTRPERM'; exit 1; }
while [ $# -gt 0 ]; do [ "$1" != -o ] || echo profile >"$2.ncu-rep"; shift; done
"""

SPLASHSURF = r"""
echo '[10:15:20.100][INFO] Starting classification of particles'
echo '[10:15:24.100][INFO] Global mesh has 10 vertices and 12 triangles'
echo '[23:59:59.500][INFO] Starting classification of particles'
echo '[00:00:02.750][INFO] Global mesh has 10 vertices and 12 triangles'
"""

MENISCUSD = r"""
[ -z "${FAKE_NO_SERVER:-}" ] || { echo 'the CUDA backend cannot be used'; exit 2; }
echo 'meniscusd listening on unix:there'
exec sleep 60
"""

MENISCUS_LOAD = r"""
while [ $# -gt 0 ]; do [ "$1" != --json ] || echo '{"frames": 80}' >"$2"; shift; done
"""

COMPUTE_SANITIZER = r"""
tool=$2
[ "${FAKE_HAZARD:-}" != "$tool" ] || { echo '========= ERROR SUMMARY: 1 error'; exit "$4"; }
shift 4
"$@"
"""
