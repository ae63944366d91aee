# SPDX-License-Identifier: Apache-2.0
# Doxygen's filter for pages: GitHub's formulas and links to headings in Doxygen's own words. Code stays as it is.
#   awk -f tools/ci/doxygen_markdown.awk PAGE.md

# The name of a heading: GitHub's anchor behind the page's name, because Doxygen's names are those of the whole project.
function label(page, heading) {
  heading = tolower(heading)
  gsub(/[^a-z0-9 _-]/, "", heading)
  gsub(/ /, "-", heading)
  return page "_" heading
}

# $x$ and $$x$$ as Doxygen writes formulas.
function formulas(text) {
  if (text ~ /^\$\$.*\$\$$/) return "\\f[" substr(text, 3, length(text) - 4) "\\f]"
  gsub(/\$/, "\\f$", text)
  return text
}

# [text](page.md#heading) and [text](#heading) as references that Doxygen checks.
function links(text, before, target, page) {
  while (match(text, /\]\([A-Za-z0-9_.\/-]*(\.md)?#[a-z0-9-]+\)/)) {
    before = before substr(text, 1, RSTART)
    target = substr(text, RSTART + 2, RLENGTH - 3)
    text = substr(text, RSTART + RLENGTH)
    page = target
    sub(/#.*/, "", page)
    sub(/.*\//, "", page)
    sub(/\.md$/, "", page)
    sub(/.*#/, "", target)
    before = before "(@ref " label(page == "" ? own : page, target) ")"
  }
  return before text
}

# Everything but `code`.
function prose(text, parts, count, i, out) {
  text = links(text)
  count = split(text, parts, "`")
  for (i = 1; i <= count; ++i) out = out (i > 1 ? "`" : "") (i % 2 ? formulas(parts[i]) : parts[i])
  return out
}

BEGIN {
  own = ARGV[1]
  sub(/.*\//, "", own)
  sub(/\.md$/, "", own)
}
/^```/ { code = !code; print; next }
code { print; next }
/^#+ / {
  heading = $0
  sub(/^#+ /, "", heading)
  print $0 " {#" label(own, heading) "}"
  next
}
{ print prose($0) }
