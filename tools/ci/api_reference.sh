#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the API reference with Doxygen: build/api/html/index.html. These are errors:
#   - a warning of Doxygen: a wrong parameter, a reference to nothing, a faulty page
#   - a class without a comment
#   - a function with arguments and without a comment, in the headers that a user of a library includes
# Constructors, operators and accessors need no comment: their class has one.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

tools/packages.sh docs
mkdir -p build/api
bad=0
doxygen Doxyfile || bad=1

# Everything that has no comment, as Doxygen sees it. XML is the quickest of its outputs.
undocumented() {
  { cat Doxyfile && printf '%s\n' WARN_IF_UNDOCUMENTED=YES WARN_AS_ERROR=NO GENERATE_HTML=NO GENERATE_XML=YES XML_PROGRAMLISTING=NO; } |
    doxygen - 2>&1 | sed -n "s#^$PWD/\(.*\): warning: \(.*\) is not documented\.#\1: \2#p" | sort -u
}
readonly user_headers='^(hal|drivers)/|^onboard/(robot|odometry/odometry|mapping/mapper)\.hpp|^fusion/(matching/matcher|merging/merge|team/team)\.hpp'
lacking=$(undocumented | awk -v headers="$user_headers" '
  / Compound / { print; next }
  !/ \(function\) of / || $1 !~ headers { next }
  {
    name = $3
    sub(/\(.*/, "", name)
    class = $NF
    sub(/.*::/, "", class)
    if (name == class || name ~ /^operator/ || /Member [a-z_0-9A-Z]+\(\)/) next
    print
  }')
if [[ -n $lacking ]]; then
  printf 'without a comment:\n%s\nremedy: say above it what it is, with units, frames, ownership and errors\n' "$lacking" >&2
  bad=1
fi
((bad == 0)) && echo "build/api/html/index.html"
exit "$bad"
