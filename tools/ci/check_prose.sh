#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Checks what people read: README.md, the other pages and docs/*.md.
#   tools/ci/check_prose.sh [BUILD_FOLDER]      default: build/dev
# It checks lengths of lines and sentences, sizes of pictures, links, and that each file, command and option that a page
# names exists. Options of commands are compared with the --help of the programs in BUILD_FOLDER/bin, where there are any.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly programs=${1:-build/dev}/bin
readonly max_readme_lines=120 max_columns=100 max_mean_words=18 max_picture_bytes=$((300 * 1024))
pages=(README.md ARCHITECTURE.md CONTRIBUTING.md SECURITY.md docs/*.md)

bad=0
fail() {  # fail WHAT REMEDY
  printf '%s\n  remedy: %s\n' "$1" "$2" >&2
  bad=1
}

# Length of lines: tables, code, formulas and the targets of links are exempt.
long_lines() {
  LC_ALL=C awk -v max="$max_columns" '
    FNR == 1 { code = 0 }
    /^```/ { code = !code; next }
    code || /^\|/ || /^<!--/ || /^\$\$/ { next }
    { text = $0; gsub(/\]\([^)]*\)/, "]", text); gsub(/[\200-\277]/, "", text) }  # characters, not bytes
    length(text) > max { print FILENAME ":" FNR ": " length(text) " columns" }' "$@"
}

# Mean number of words in a sentence of PAGE. A list item ends a sentence. Code and formulas count as one word.
mean_words() {
  awk '
    function finish() { if (words > 0) { ++sentences; all += words } words = 0 }
    /^```/ { code = !code; finish(); next }
    code { next }
    /^\$\$/ || /^\|/ || /^#/ || /^<!--/ || /^ *$/ { finish(); next }
    /^ *([-*]|[0-9]+\.) / { finish(); sub(/^ *([-*]|[0-9]+\.) /, "") }
    {
      gsub(/`[^`]*`/, "code")
      gsub(/\$[^$]*\$/, "formula")
      gsub(/\]\([^)]*\)/, "]")
      count = split($0, tokens, / +/)
      for (i = 1; i <= count; ++i) {
        if (tokens[i] ~ /[A-Za-z0-9]/) ++words
        if (tokens[i] ~ /[.!?][\])"*]*$/) finish()
      }
    }
    END { finish(); if (sentences) printf "%.1f\n", all / sentences }' "$1"
}

# The anchors of PAGE, as GitHub makes them of headings.
anchors() {
  awk '
    /^```/ { code = !code }
    !code && /^#+ / { sub(/^#+ /, ""); $0 = tolower($0); gsub(/[^a-z0-9 _-]/, ""); gsub(/ /, "-"); print }' "$1"
}

# The links of PAGE to files of this repository, one a line.
links() {
  awk '/^```/ { code = !code } !code' "$1" | tr '\n' ' ' | grep -oE '\]\([^)]+\)' | sed -E 's/^\]\(//; s/\)$//' |
    grep -vE '^(https?|mailto):' || true
}

# The lines of code blocks of PAGE, those of C++ and CMake apart: they are examples. A line that ends in a backslash goes
# on in the next.
code() {
  awk '/^```/ { inside = !inside; example = /^```c/; next } inside && !example { sub(/ # .*/, ""); print }' "$1" |
    sed -e ':a' -e '/\\$/N; s/\\\n */ /; ta'
}
# What stands in `…`.
# shellcheck disable=SC2016  # backticks, to be taken as they are
spans() { awk '/^```/ { inside = !inside; next } !inside' "$1" | tr '\n' ' ' | grep -oE '`[^`]+`' | tr -d '`' || true; }

(($(wc -l <README.md) <= max_readme_lines)) ||
  fail "README.md has more than $max_readme_lines lines" "move what is long to a page in docs/"
lines=$(long_lines "${pages[@]}")
[[ -z $lines ]] || fail "$lines" "prose has at most $max_columns columns: break the line"
for page in "${pages[@]}"; do
  mean=$(mean_words "$page")
  awk -v mean="$mean" -v max="$max_mean_words" 'BEGIN { exit (mean > max) }' ||
    fail "$page: $mean words a sentence" "one fact a sentence, $max_mean_words words on average at most"
done
while read -r bytes picture; do
  ((bytes <= max_picture_bytes)) || fail "$picture: $bytes bytes" "make it smaller: tools/pictures.sh"
done < <(find docs -type f \( -name '*.png' -o -name '*.jpg' -o -name '*.svg' \) -printf '%s %p\n')

declare -A anchors_of=()
check_link() {  # check_link PAGE TARGET
  local file=${2%%#*} folder=. target=$1
  [[ $1 != */* ]] || folder=${1%/*}
  [[ -z $file ]] || target=$folder/$file
  if [[ ! -e $target ]]; then
    fail "$1: link to $2" "there is no such file"
  elif [[ $2 == *'#'* ]]; then
    [[ -n ${anchors_of[$target]:-} ]] || anchors_of[$target]=$'\n'$(anchors "$target")$'\n'
    [[ ${anchors_of[$target]} == *$'\n'"${2#*#}"$'\n'* ]] || fail "$1: link to $2" "there is no such heading"
  fi
}

sources=$(find .ci config docs drivers fusion hal onboard tests toolchains tools -type f)$'\n'
# Every option that a program or a script has.
options=$'\n'$(grep -rhoE -- '--[a-z][a-z-]*' onboard/app tools drivers/peers .ci tests/vm | sort -u)$'\n'
readonly rooms='^\.?/?(\.ci|config|docs|drivers|fusion|hal|onboard|tests|toolchains|tools)(/|$)'

exists() {  # exists NAME: a path from the root, or the end of one; the ending of a source file may be left out
  local name=${1#./}
  name=${name%/}
  compgen -G "$name" >/dev/null || compgen -G "$name.[ch]pp" >/dev/null || compgen -G "$name.sh" >/dev/null && return
  [[ $1 =~ $rooms ]] && return 1
  [[ $sources =~ "/$name"(\.[ch]pp)?(/|$'\n') ]]
}

check_names() {  # check_names PAGE: words that look like a file of this repository
  local name pattern="$rooms|^[a-z0-9_/]+\.(hpp|cpp)$"
  [[ $1 != ARCHITECTURE.md ]] || pattern+='|^[a-z_/]+/$'  # folders, below the room of their line
  while read -r name; do
    [[ $name == *[A-Z][A-Z][A-Z]* && $name != *.md ]] && continue  # a placeholder, such as drivers/NAME
    exists "$name" || fail "$1: names $name" "there is no such file in the repository"
  done < <(tr ' =(),;"' '\n' <<<"$page_spans"$'\n'"$page_code" | sed 's/[.:]$//' | grep -E "$pattern" | sort -u)
}

declare -A helps=()
help_of() {  # help_of PROGRAM [COMMAND…]: what --help says; in $help
  local key=$*
  [[ -n ${helps[$key]:-} ]] || helps[$key]=$'\n'$(timeout 60 "$programs/$1" "${@:2}" --help 2>/dev/null </dev/null || true)
  help=${helps[$key]}
}

check_command() {  # check_command PAGE WORD…: a call of one of the programs
  local page=$1 program=$2 line="${*:2}" word help
  local -a commands=()
  shift 2
  help_of "$program"
  while (($# > 0)) && [[ $1 != -* && $help == *$'\n'"  $1 "* ]]; do
    commands+=("$1")
    help_of "$program" "${commands[@]}"
    shift
  done
  if [[ $program == cairn ]] && ((${#commands[@]} == 0)) && [[ ${1:---help} != -* ]]; then
    fail "$page: $line" "there is no such command"
  fi
  for word in "$@"; do
    [[ $word == --* ]] || continue
    [[ $help =~ [[:space:],]${word%%=*}([[:space:],]|$) ]] || fail "$page: $line" "the command has no option $word"
  done
}

check_options() {  # check_options PAGE: options that stand alone in the text
  local option
  while read -r option; do
    [[ $options == *$'\n'"$option"$'\n'* ]] || fail "$1: $option" "nothing has this option"
  done < <(tr ' ' '\n' <<<"$page_spans" | grep -E '^--[a-z-]+$' | sort -u)
}

[[ -x $programs/cairn ]] || echo "commands are not checked: $programs/cairn is not built"
for page in "${pages[@]}"; do
  page_spans=$(spans "$page") page_code=$(code "$page")
  while read -r target; do [[ -z $target ]] || check_link "$page" "$target"; done < <(links "$page")
  check_names "$page"
  check_options "$page"
  while read -r -a call; do
    [[ ! -x $programs/${call[0]} ]] || check_command "$page" "${call[@]}"
  done < <(tr ';|&' '\n' <<<"$page_code"$'\n'"$page_spans" | sed -E 's/^ *(sudo )?//; s/ #.*//' | grep -E '^cairn(-core|-peers)? ')
done

((bad == 0)) && echo "prose: ${#pages[@]} pages are in order"
exit "$bad"
