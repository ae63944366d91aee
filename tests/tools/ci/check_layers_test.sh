#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Plants one violation after the other in a small tree: each must be found, named and come with its remedy. What is
# allowed must pass.
set -euo pipefail
check=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)/tools/ci/check_layers.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
failures=0

plant() {  # plant FILE LINE…: a file that keeps the rules but for the given lines
  local file=$tree/$1
  shift
  mkdir -p "$(dirname "$file")"
  case $file in
    *.hpp) printf '// SPDX-License-Identifier: Apache-2.0\n#pragma once\n' >"$file" ;;
    *.cpp) printf '// SPDX-License-Identifier: Apache-2.0\n' >"$file" ;;
    *) printf '# SPDX-License-Identifier: Apache-2.0\n' >"$file" ;;
  esac
  printf '%s\n' "$@" >>"$file"
}
fresh() {
  rm -rf "${tree:?}"/*
  mkdir -p "$tree"/{drivers/velodyne,drivers/recording,drivers/camera,drivers/thermal,onboard,fusion,tools,tests,toolchains}
  plant hal/time.hpp
}
complain() { echo "FAILED: $*"; failures=$((failures + 1)); }

expected=()
denied() {  # denied RULE FILE LINE…: plants it under a name of its own; report() expects that below the rule
  local rule=$1 file=${2%.*}_${#expected[@]}.${2##*.}
  shift 2
  expected+=("$rule|$file")
  plant "$file" "$@"
}
report() {  # runs the check over all that was planted
  local out one rule file
  if out=$("$check" "$tree" 2>&1); then complain "violations pass"; fi
  for one in "${expected[@]}"; do
    rule=${one%|*} file=${one#*|}
    # A rule's paragraph: its name, the remedy, then indented places.
    awk -v rule="$rule" -v file="    $file" '/^[^ ]/ {on = index($0, rule)} on && /^  remedy: ./ {remedy = 1}
      on && remedy && index($0, file) == 1 {found = 1} END {exit !found}' <<<"$out" || complain "not found: $one"
  done
}

fresh
denied "hal knows nobody" hal/a.cpp '#include "onboard/robot.hpp"'
denied "drivers know only hal" drivers/velodyne/a.cpp '#include "onboard/robot.hpp"'
denied "a driver does not know other drivers" drivers/velodyne/a.cpp '#include "drivers/recording/index.hpp"'
denied "a driver does not know other drivers" drivers/velodyne/a.cpp '#include "drivers/camera/frame.hpp"'
denied "a driver does not know other drivers" drivers/camera/a.cpp '#include "drivers/thermal/models.hpp"'
denied "decoding is pure" drivers/thermal/decoder.cpp '#include "drivers/camera/v4l2_source.hpp"'
denied "decoding is pure" drivers/velodyne/decoder.cpp '#include "drivers/velodyne/udp_source.hpp"'
denied "onboard knows only hal" onboard/mapping/a.hpp '#include "drivers/velodyne/decoder.hpp"'
denied "onboard knows neither tools nor tests" onboard/mapping/a.hpp '#include "tools/cli/command.hpp"'
denied "only onboard/app, tools and tests know onboard/app" onboard/mapping/a.hpp '#include "onboard/app/config.hpp"'
denied "fusion knows only hal and onboard/mapping" fusion/team.cpp '#include "onboard/odometry/odometry.hpp"'
denied "the program does not know tests" onboard/app/a.cpp '#include "tests/support/a.hpp"'
denied "the program does not know tests" tools/a.cpp '#include "tests/support/a.hpp"'
denied "includes name the path from the project's root" onboard/mapping/a.cpp '#include "../robot.hpp"'
denied "includes name the path from the project's root" onboard/mapping/a.cpp '#include "tree.hpp"'

plant onboard/safety/a.cpp '#include "onboard/scheduler/a.hpp"'
plant onboard/scheduler/b.cpp '#include "onboard/safety/a.hpp"'
expected+=("folders do not depend on each other in a circle|onboard/scheduler")
denied "onboard knows neither tools nor tests" onboard/app/a.hpp '#include "tools/cli/command.hpp"'

denied "only hal/clock.cpp reads" onboard/robot.cpp 'auto t = std::chrono::steady_clock::now();'
denied "only hal/clock.cpp reads" tests/hal/a.cpp 'clock_gettime(CLOCK_MONOTONIC, &t);'
denied "only hal/clock.cpp reads" tools/a.cpp 'auto t = std::time(nullptr);'
denied "nobody sleeps" tests/hal/a.cpp 'std::this_thread::sleep_for(1ms);'
denied "only hal/workers and onboard/scheduler/threads start threads" onboard/robot.cpp 'std::thread t([] {});'
denied "only hal/workers and onboard/scheduler/threads start threads" onboard/robot.cpp '#pragma omp parallel for'
denied "sockets belong to drivers" onboard/app/a.cpp '#include <sys/socket.h>'
denied "sockets belong to drivers" drivers/velodyne/decoder.cpp '#include <netinet/in.h>'
denied "sockets belong to drivers" tests/vm/helper.cpp '#include <sys/socket.h>'
denied "only drivers speak to other machines" onboard/app/a.cpp 'int fd = ::socket(AF_INET, SOCK_STREAM, 0);'
denied "devices belong to drivers" hal/a.cpp '#include <linux/gpio.h>'
denied "OctoMap's own readers" tools/a.cpp 'tree.readBinary(path);'

denied "builds run on every machine" hal/flags.cmake 'add_compile_options(-march=native)'
denied "fixed seeds" tests/hal/a.cpp 'std::random_device seed;'
denied "what is left to do" hal/a.cpp '// TO''DO: later'
denied "no path of one machine" tools/a.sh 'cd /ho''me/somebody/cairn'
denied "a file has at most" hal/a.cpp "$(seq -f '// %g' 300)"

echo 'int x;' >"$tree/hal/unlicensed.cpp" && expected+=("every source says its licence|hal/unlicensed.cpp")
printf '// SPDX-License-Identifier: Apache-2.0\n' >"$tree/hal/twice.hpp" && expected+=("every header has|hal/twice.hpp")
report

fresh
plant drivers/recording/a.cpp '#include "drivers/velodyne/packet.hpp"'
plant drivers/recording/b.cpp '#include "drivers/camera/frame.hpp"'
plant drivers/thermal/a.cpp '#include "drivers/camera/frame.hpp"'
plant drivers/camera/v4l2_source.cpp '#include <linux/videodev2.h>'
plant onboard/app/a.cpp '#include "drivers/velodyne/decoder.hpp"'
plant fusion/team.cpp '#include "onboard/mapping/tree.hpp"'
plant onboard/app/a.hpp 'Time t = door.clock().now();'
plant drivers/velodyne/config.cpp '#include <arpa/inet.h>'
plant hal/clock.cpp 'clock_gettime(CLOCK_MONOTONIC, &t);'
plant onboard/robot.cpp 'auto n = std::thread::hardware_concurrency();'
plant hal/workers.hpp 'std::vector<std::thread> pool_;'
plant drivers/velodyne/udp_source.cpp '#include <sys/socket.h>'
plant tests/vm/uvc_camera.cpp '#include <sys/socket.h>'
plant onboard/app/live/sd_notify.cpp '#include <sys/un.h>'
plant hal/a.cpp "$(seq -f '// %g' 299)"
out=$("$check" "$tree" 2>&1) || complain "wrongly denied: $out"

rm -rf "${tree:?}"/*
! "$check" "$tree" >/dev/null 2>&1 || complain "an empty tree passes"

((failures == 0)) && echo "every planted violation was found"
exit $((failures > 0))
