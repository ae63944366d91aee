// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cairn::report::html {

/// The style sheet of report.html. Light and dark follow the reader's system.
inline constexpr const char* kStyle = R"css(
:root { color-scheme: light dark; --page: #f3f5f8; --card: #fff; --ink: #18202b; --soft: #5c6878; --line: #dde2e9;
  --grid: #e6eaf0; --accent: #1769aa; --path: #d81b60; --good: #1f7a4d; --warn: #b3600a; --bad: #b3261e;
  --unknown: #d9dee6; --free: 1; --band: #1769aa26; --bars: #7fa9cf; }
@media (prefers-color-scheme: dark) { :root { --page: #10151b; --card: #181f28; --ink: #e4e9f0; --soft: #97a3b3;
  --line: #2b3542; --grid: #26303c; --accent: #6ab4f0; --path: #ff6fa3; --good: #5cc592; --warn: #f0a95a; --bad: #ff8a80;
  --unknown: #10151b; --free: .13; --band: #6ab4f030; --bars: #3f6c96; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 20px 16px 40px; }
header { display: flex; flex-wrap: wrap; align-items: baseline; gap: 4px 16px; margin-bottom: 14px; }
h1 { font-size: 24px; margin: 0; letter-spacing: -.01em; }
h2 { font-size: 17px; margin: 0 0 12px; }
header p { margin: 0; color: var(--soft); overflow-wrap: anywhere; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 16px 18px; margin: 14px 0; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 10px; }
.tile { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 10px 14px; }
.tile b { display: block; font-size: 22px; font-weight: 650; font-variant-numeric: tabular-nums; line-height: 1.25; }
.tile span { display: block; color: var(--soft); font-size: 13px; }
.tile small { color: var(--soft); font-size: 12px; }
.tile.good b { color: var(--good); } .tile.warn b { color: var(--warn); } .tile.bad b { color: var(--bad); }
.notes { list-style: none; margin: 0; padding: 0; display: grid; gap: 6px; }
.notes li { padding-left: 22px; position: relative; overflow-wrap: anywhere; }
.notes small { display: block; color: var(--soft); }
.notes li::before { content: ""; position: absolute; left: 3px; top: .45em; width: 10px; height: 10px; border-radius: 50%; background: var(--good); }
.notes li.warn::before { background: var(--warn); border-radius: 2px; }
.notes li.bad::before { background: var(--bad); border-radius: 0; transform: rotate(45deg); }
svg { display: block; width: 100%; height: auto; font: 12.5px system-ui, "DejaVu Sans", sans-serif; }
svg text { fill: var(--soft); } svg .r { text-anchor: end; } svg .m { text-anchor: middle; }
svg path { fill: none; } svg text.p99, svg text.budget, .map .bar text { paint-order: stroke; stroke: var(--card); stroke-width: 4px; } svg .grid { stroke: var(--grid); } svg .axis { stroke: var(--soft); stroke-opacity: .7; }
svg .curve { stroke-width: 1.6; stroke: var(--accent); stroke-linejoin: round; } svg .curve.path { stroke: var(--path); }
svg .band { fill: var(--band); stroke: none; } svg .bars { fill: var(--bars); } svg .cpu { stroke: var(--ink); stroke-width: 1.2; }
svg path.p99 { stroke: var(--accent); stroke-width: 1.4; } svg text.p99 { fill: var(--accent); }
svg path.budget { stroke: var(--bad); stroke-width: 1.4; stroke-dasharray: 5 3; } svg text.budget { fill: var(--bad); }
svg.map { background: var(--unknown); border-radius: 6px; font-size: 17px; max-height: 86vh; }
.map image { image-rendering: pixelated; } .map .free { opacity: var(--free); }
.map path.grid { stroke: var(--ink); stroke-opacity: .09; }
.map .halo { stroke: var(--card); stroke-opacity: .8; stroke-width: 5; stroke-linejoin: round; }
.map .halo, .map .trajectory, .map .truth { vector-effect: non-scaling-stroke; } .map .trajectory { stroke: var(--path); stroke-width: 2.6; stroke-linejoin: round; }
.map .truth { stroke: var(--ink); stroke-width: 1.8; stroke-dasharray: 9 7; }
.map .person { vector-effect: non-scaling-stroke; stroke: var(--accent); stroke-width: 1.6; stroke-linejoin: round; } .key i.person { border-top: 2px solid var(--accent); }
.map circle { stroke: var(--card); stroke-width: 2.5; } .map .start { fill: var(--good); } .map .end { fill: var(--path); }
.map .bar path { stroke: var(--ink); stroke-width: 2; } .map .bar text { fill: var(--ink); }
.map .bar .halo { stroke: var(--card); stroke-width: 6; }
.key { display: flex; flex-wrap: wrap; gap: 4px 18px; margin-top: 10px; color: var(--soft); font-size: 13px; align-items: center; }
.key i { display: inline-block; width: 22px; height: 0; border-top: 3px solid var(--path); vertical-align: middle; margin-right: 6px; }
.key i.truth { border-top: 2px dashed var(--ink); } .key i.bars { border-top: 9px solid var(--bars); }
.key i.cpu { border-top: 2px solid var(--ink); } .key i.p99 { border-top: 2px solid var(--accent); }
.key i.budget { border-top: 2px dashed var(--bad); } .key i.band { border-top: 10px solid var(--band); } .key i.curve { border-color: var(--accent); }
.key i.class { width: 12px; height: 12px; border-top: 0; border-radius: 2px; }
.key .ramp { display: inline-block; width: 110px; height: 10px; border-radius: 3px; vertical-align: middle; margin: 0 6px; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 400px), 1fr)); gap: 14px 22px; }
figure { margin: 0; min-width: 0; } figcaption { font-weight: 600; font-size: 14px; margin-bottom: 2px; overflow-wrap: anywhere; }
figcaption span { font-weight: 400; color: var(--soft); margin-left: 4px; }
.scroll { overflow-x: auto; margin: 0 -18px; padding: 0 18px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; font-size: 14px; }
th, td { padding: 5px 10px 5px 0; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th { color: var(--soft); font-weight: 500; font-size: 13px; } tr:last-child td { border-bottom: 0; }
th[colspan] { text-align: center; } th.l, td.l { text-align: left; } td.w { white-space: normal; overflow-wrap: anywhere; min-width: 180px; }
td.bad { color: var(--bad); font-weight: 600; } td.warn { color: var(--warn); } td.good { color: var(--good); }
.charts + .key, .scroll + .charts, .key + .charts { margin-top: 14px; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 300px), 1fr)); gap: 0 34px; }
.facts { width: auto; margin-top: 10px; } .facts td { white-space: normal; padding-right: 28px; } .facts td:last-child { text-align: left; }
.pair td:first-child, .facts td:first-child { text-align: left; color: var(--soft); } .pair td:last-child { padding-right: 0; }
summary { cursor: pointer; font-weight: 600; } pre { overflow-x: auto; font: 12.5px/1.45 ui-monospace, "DejaVu Sans Mono", monospace; margin: 12px 0 0; }
footer { color: var(--soft); font-size: 13px; overflow-wrap: anywhere; margin-top: 18px; }
@media print { section, .tile { break-inside: avoid; } body { background: #fff; } }
)css";

}  // namespace cairn::report::html
