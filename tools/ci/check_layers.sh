#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The house rules that a compiler cannot check. Each message says what to do instead.
#   tools/ci/check_layers.sh [ROOT]
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"

readonly max_lines=300
# Files that may be longer, each with its reason:
readonly long_files='^$'

bad=0
code() { find "$@" \( -name '*.hpp' -o -name '*.cpp' \) -type f 2>/dev/null || true; }

# deny RULE REMEDY PATTERN ALLOWED FILE…: no line of the files matches, except in files whose path matches ALLOWED.
deny() {
  local rule=$1 remedy=$2 pattern=$3 allowed=$4 hits
  shift 4
  hits=$(printf '%s\n' "$@" | grep -Ev "^$|$allowed" | xargs -r -d '\n' grep -HnEI -- "$pattern" | sed 's/^/    /') || true
  [[ -n $hits ]] || return 0
  printf '%s\n  remedy: %s\n%s\n' "$rule" "$remedy" "$hits" >&2
  bad=1
}
# The same, for files of which none may exist.
deny_files() {
  local rule=$1 remedy=$2
  shift 2
  (($# > 0)) || return 0
  printf '%s\n  remedy: %s\n' "$rule" "$remedy" >&2
  printf '    %s\n' "$@" >&2
  bad=1
}

readonly none='^$'  # no path matches: nothing is exempt
inc() { printf '^ *# *include *[<"](%s)' "$1"; }

mapfile -t hal < <(code hal)
mapfile -t drivers < <(code drivers)
mapfile -t onboard < <(code onboard)
mapfile -t fusion < <(code fusion)
mapfile -t tools < <(code tools)
mapfile -t examples < <(code examples)
mapfile -t tests < <(code tests)
product=("${hal[@]}" "${drivers[@]}" "${onboard[@]}" "${fusion[@]}" "${tools[@]}" "${examples[@]}")
all=("${product[@]}" "${tests[@]}")
((${#hal[@]} > 0)) || { echo "check_layers.sh: no source files below $PWD" >&2; exit 2; }

# Who may include whom
deny "hal knows nobody" "move the word both sides need into hal/, or hand the thing in through a port of hal/ports.hpp" \
  "$(inc '(drivers|onboard|fusion|tools|tests)/')" "$none" "${hal[@]}"
deny "drivers know only hal" "hand the result on as one of hal's types; onboard/app connects driver and stage" \
  "$(inc '(onboard|fusion|tools|tests)/')" "$none" "${drivers[@]}"
deny "onboard knows only hal; onboard/app may also know drivers and fusion" "take a port of hal/ports.hpp as argument" \
  "$(inc '(drivers|fusion)/')" '^onboard/(app|client)/|^onboard/report/figures/trajectory_error\.[ch]pp$' "${onboard[@]}"
mapfile -t client < <(code onboard/client)
not_clients=$(printf '%s\n' drivers/*/ | xargs -n 1 basename | grep -vx clients | paste -sd '|')
deny "onboard/client knows only hal, drivers/clients, onboard/mapping and fusion/peers" "let it see messages and maps only" \
  "$(inc "(drivers/($not_clients)|fusion/(matching|merging|team)|onboard/(app|odometry|report|safety|scheduler)|tools)/|onboard/robot\.")" \
  "$none" "${client[@]}"
deny "examples know what other programs may know" "use hal, drivers/clients and onboard/client" \
  "$(inc "(drivers/($not_clients)|fusion|onboard/(app|odometry|report|safety|scheduler)|tools|tests)/")" "$none" "${examples[@]}"
deny "onboard knows neither tools nor tests" "move what is needed into the room that owns it" \
  "$(inc '(tools|tests)/')" "$none" "${onboard[@]}"
deny "the program does not know tests" "move what is needed out of tests/" "$(inc 'tests/')" "$none" "${product[@]}"
deny "fusion knows only hal and onboard/mapping" "let it see maps and poses only" \
  "$(inc '(drivers|tools|tests|onboard/(app|odometry|perception|report|safety|scheduler|[a-z_]+\.))')" "$none" "${fusion[@]}"
deny "only onboard/app, tools and tests know onboard/app" "move the shared part down into its own room" \
  "$(inc 'onboard/app/')" '^onboard/app/' "${hal[@]}" "${drivers[@]}" "${onboard[@]}" "${fusion[@]}"
deny "includes name the path from the project's root" "write \"room/file.hpp\"" '^ *# *include *"(\.\.?/|[^/"]+")' "$none" "${all[@]}"
for driver in drivers/*/; do
  name=$(basename "$driver")
  others=$(printf '%s\n' drivers/*/ | xargs -n 1 basename | grep -vx -e "$name" | paste -sd '|')
  case $name in
    recording) others=${others//velodyne/-} others=${others//camera/-} others=${others//drive/-} others=${others//gpio/-} others=${others//peers/-} others=${others//clients/-} ;;  # their native files
    thermal | depth) others=${others//camera/-} ;;                         # their frames come from drivers/camera
  esac
  mapfile -t own < <(code "$driver")
  [[ -z $others ]] || deny "a driver does not know other drivers" "put what both need into hal/" \
    "$(inc "drivers/($others)/")" "$none" "${own[@]}"
done
deny "decoding is pure: it never knows its transport" "decode a std::span; the transport calls the decoder" \
  "$(inc '(drivers/[a-z_/]+/(udp|pcap|v4l2|socket_link|socketcan|unix_can|libgpiod)_?|sys/socket|pcap|gpiod)')" \
  '/(udp|pcap|v4l2|socket_link|socketcan|unix_can|libgpiod|import|record)[a-z0-9_]*\.|^drivers/recording/|^drivers/peers/(domain_claim|local_link|peer_process)\.|^drivers/clients/sockets/' "${drivers[@]}"

# Folders
readonly max_files=30
mapfile -t crowded < <(find hal drivers onboard fusion tools examples tests -type f -not -path '*/corpus/*' 2>/dev/null |
  sed 's#/[^/]*$##' | sort | uniq -c | awk -v max="$max_files" '$1 > max {print $2 ": " $1 " files"}')
deny_files "a folder has at most $max_files files" "make folders of what belongs together" "${crowded[@]}"
# Who includes whom, folder by folder; tsort names a circle where there is one.
circle=$(printf '%s\n' "${product[@]}" | xargs -d '\n' grep -HoE '^ *# *include *"[^"]+/[^"]+"' |
  sed -E 's#^(.*)/[^/]+: *\# *include *"(.*)/[^/]+"$#\1 \2#' | awk '$1 != $2' | sort -u | tsort 2>&1 >/dev/null |
  sed 's/^tsort: //') || true
mapfile -t circle < <(grep -v 'contains a loop' <<<"$circle" | grep -v '^$')
deny_files "folders do not depend on each other in a circle" "move what both need into a folder below both" "${circle[@]}"

# Time, threads, devices
deny "only hal/clock.cpp reads the machine's clock" "take a Clock or a Time as argument; CPU time is thread_cpu_time()" \
  '(steady|system|high_resolution|file|utc)_clock|clock_gettime|gettimeofday|timespec_get|std::(time|clock)\(|\btime\((NULL|nullptr|0)\)|__rdtsc' \
  '^hal/clock\.cpp$' "${all[@]}"
deny "nobody sleeps" "wait for data with a time-out (poll), or advance the VirtualClock" \
  'sleep_(for|until)|\b(u|nano)?sleep\(|clock_nanosleep' '^hal/clock\.cpp$' "${all[@]}"
deny "only hal/workers and onboard/scheduler/threads start threads" \
  "compute with Workers::for_each, whose result is the same for any number of threads; make a fixed-rate job a scheduler::Task" \
  'std::(jthread|async|packaged_task|execution::)|std::thread\b($|[^:])|pthread_create|# *pragma +omp|tbb::|include *<tbb/' \
  '^hal/workers\.[ch]pp$|^onboard/scheduler/threads\.[ch]pp$' "${all[@]}"
# Local sockets alone (AF_UNIX): the service manager's and the live view's, which housekeeping serves and no real-time
# thread. Whatever comes from another machine enters by a driver.
readonly local_sockets='onboard/app/live/(sd_notify|live_server)\.cpp|tools/cli/top/live_client\.cpp|tests/support/local_socket\.hpp|drivers/peers/(domain_claim|local_link)\.cpp|drivers/clients/sockets/local_[a-z]+\.[ch]pp'
# CAN buses that a program of this machine plays (AF_UNIX), both ends.
readonly local_buses='drivers/drive/can/(socket_link|unix_can_link)\.cpp|tests/drivers/drive/can/unix_can_link_test\.cpp|tools/simulator/live/can_hub\.cpp'
# Networks that end on this machine: those of the robots of `cairn team`.
readonly emulated_networks='tools/team/network/tun_device\.cpp'
deny "sockets belong to drivers" "put it into drivers/*/udp_* or socketcan_*, behind a Source" \
  "$(inc '(sys/socket|sys/un|netinet/|netdb|net/if|netpacket/|linux/(can|if_|net))')" \
  "^(drivers|tests/drivers)/[a-z_/]+/(udp|socketcan)_[a-z_]*\\.|^tests/vm/uvc_camera\\.cpp$|^($local_sockets|$local_buses|$emulated_networks)$" "${all[@]}"
deny "only drivers speak to other machines" "put it into drivers/*/udp_*" '\b(AF|PF)_(INET6?|PACKET|CAN)\b' \
  "^(drivers|tests/drivers|tests/vm)/|^($emulated_networks)$" "${all[@]}"
deny "devices belong to drivers" "put it into drivers/, behind a port of hal/ports.hpp" \
  "$(inc '(termios|sys/ioctl|arpa/|linux/|pcap|gpiod)')" \
  "^(tests/)?drivers/|^tools/cli/top/top_command\\.cpp$|^($emulated_networks)$" "${all[@]}"  # the exception asks for the size of its terminal
deny "OctoMap's own readers recurse without bounds on hostile files" "read maps with onboard/mapping's reader" \
  '(AbstractOcTree|AbstractOccupancyOcTree|OcTree)::read|(\.|->)read(Binary|BinaryData|Data)\(' '^tests/' "${all[@]}"

# Results must be the same on every machine and every run
mapfile -t builds < <(find CMakeLists.txt CMakePresets.json hal drivers onboard fusion tools examples tests toolchains \
  \( -name CMakeLists.txt -o -name '*.cmake' -o -name CMakePresets.json \) -type f 2>/dev/null)
deny "builds run on every machine of their kind and give the same bits" \
  "dispatch per function at run time, or use a toolchain file" \
  '-march=native|-mtune=native|-ffast-math|-Ofast|-funsafe-math|-ffp-contract=(fast|on)' "$none" "${builds[@]}" "${all[@]}"
# A team's epoch alone must differ from all others; it enters as a packet and is recorded.
deny "fixed seeds" "seed with a number that is in the source or an argument" 'std::random_device|\bsrand\(|\brand\(\)' \
  '^onboard/app/profile/team_profile\.cpp$' "${all[@]}"

# Order in the house
mapfile -t scripts < <(find tools toolchains tests .ci \( -name '*.sh' -o -path .ci/run \) -type f 2>/dev/null)
texts=("${all[@]}" "${builds[@]}" "${scripts[@]}")
mapfile -t unlicensed < <(printf '%s\n' "${texts[@]}" | grep -v '\.json$' | xargs -d '\n' grep -L 'SPDX-License-Identifier: Apache-2.0')
deny_files "every source says its licence" "begin with: SPDX-License-Identifier: Apache-2.0" "${unlicensed[@]}"
mapfile -t long < <(printf '%s\n' "${texts[@]}" | xargs -d '\n' wc -l |
  awk -v max="$max_lines" -v allowed="$long_files" '$2 != "total" && $1 > max && $2 !~ allowed {print $2 ": " $1 " lines"}')
deny_files "a file has at most $max_lines lines" "split it by what its parts are about" "${long[@]}"
mapfile -t headers < <(printf '%s\n' "${all[@]}" | grep '\.hpp$' | xargs -d '\n' grep -L '^#pragma once$')
deny_files "every header has #pragma once" "put it below the licence line" "${headers[@]}"
deny "what is left to do is not left in the source" "do it, or file an issue" '\b(TO''DO|FIX''ME|XX''X)\b' "$none" "${texts[@]}"
deny "no path of one machine" "take it as an argument, or find it from the project's root" \
  '(^|[^A-Za-z0-9_.}])/(home|root|work|Users)/' "$none" "${texts[@]}"

((bad == 0)) && echo "layers: ${#all[@]} sources keep the rules"
exit "$bad"
