#include "runner/report/html.h"

namespace gfxrepro::report {

std::string_view reportStyle() {
    return R"css(
:root { color-scheme: light dark;
  --paper: #fdfdfb; --ink: #1d1f21; --soft: #6a6d70; --rule: #d9d7d0; --rule-strong: #55575a;
  --panel: #f4f3ee; --link: #2a5078;
  --holds: #2f6b46; --holds-bg: #e2eee5; --fails: #993030; --fails-bg: #f5e1df;
  --ambiguous: #7d5a12; --ambiguous-bg: #f5ebd3; --unmeasured: #5b5f66; --unmeasured-bg: #e9e9e7;
  --not-applicable: #5b5f66; --not-applicable-bg: transparent; }
@media (prefers-color-scheme: dark) { :root {
  --paper: #17191b; --ink: #dcdcd6; --soft: #9a9c9b; --rule: #35383b; --rule-strong: #8b8e90;
  --panel: #1f2224; --link: #9dbfe0;
  --holds: #9fd0af; --holds-bg: #20382a; --fails: #ecaaa3; --fails-bg: #472624;
  --ambiguous: #e2c583; --ambiguous-bg: #403419; --unmeasured: #b3b6ba; --unmeasured-bg: #2c2f32;
  --not-applicable: #9a9c9b; --not-applicable-bg: transparent; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.5 "Source Serif 4", "Charter", "Iowan Old Style", Georgia, serif; }
main { max-width: 80rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
h1 { font-size: 1.75rem; line-height: 1.2; font-weight: 600; margin: 0 0 .3rem; }
h2 { font-size: 1.25rem; line-height: 1.3; font-weight: 600; margin: 0 0 .3rem; }
h3 { font-size: .8rem; font-weight: 600; letter-spacing: .06em; text-transform: uppercase;
  color: var(--soft); margin: 1.6rem 0 .4rem; }
p { margin: .4rem 0; max-width: 46rem; }
a { color: var(--link); text-decoration-thickness: 1px; text-underline-offset: 2px; }
section { margin-top: 3.2rem; padding-top: 1.4rem; border-top: 1px solid var(--rule); }
.soft { color: var(--soft); } .small { font-size: .875rem; }
.facts { display: grid; grid-template-columns: max-content 1fr; gap: .1rem 1.2rem; margin: 1rem 0; }
.facts dt { color: var(--soft); } .facts dd { margin: 0; overflow-wrap: anywhere; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums lining-nums;
  border-top: 2px solid var(--rule-strong); border-bottom: 2px solid var(--rule-strong); }
th { font-weight: 600; vertical-align: bottom; text-align: left; }
thead + tbody tr:first-child > * { border-top: 1px solid var(--rule-strong); }
th, td { padding: .28rem .55rem; }
td { vertical-align: top; }
tbody tr + tr td, tbody tr + tr th { border-top: 1px solid var(--rule); }
tbody th { font-weight: 400; white-space: nowrap; vertical-align: top; }
.num { text-align: right; white-space: nowrap; }
.results thead th { text-align: right; } .results thead th.axis { text-align: left; }
.results thead th.group { text-align: center; padding-bottom: .1rem; }
.results td.printed { color: var(--soft); padding-left: 1.1rem; }
.results thead .sub { font-weight: 400; color: var(--soft); font-size: .8rem; }
.interval { display: block; color: var(--soft); font-size: .76rem; line-height: 1.25; }
.status { color: var(--fails); font-style: italic; }
.claims td, .claims th { white-space: normal; } .claims { width: 100%; }
.claims td.id { white-space: nowrap; } .claims td.measured { min-width: 10rem; }
.badge { display: inline-block; padding: 0 .5em; border-radius: .2em; font-size: .8rem;
  line-height: 1.6; white-space: nowrap; border: 1px solid transparent;
  font-family: system-ui, -apple-system, "Segoe UI", sans-serif; text-decoration: none; }
.holds { color: var(--holds); background: var(--holds-bg); }
.fails { color: var(--fails); background: var(--fails-bg); font-weight: 600; }
.ambiguous { color: var(--ambiguous); background: var(--ambiguous-bg); }
.unmeasured { color: var(--unmeasured); background: var(--unmeasured-bg); }
.not-applicable { color: var(--not-applicable); border-color: var(--rule); }
.grid td { padding: .35rem .55rem; } .grid .badge { margin: .1rem .15rem .1rem 0; }
.counts { margin: 1rem 0; } .counts .badge { font-size: .95rem; margin: .15rem .4rem .15rem 0; }
.gallery { display: grid; grid-template-columns: repeat(auto-fill, minmax(11rem, 1fr)); gap: 1rem; }
figure { margin: 0; } figure img { width: 100%; height: auto; display: block;
  border: 1px solid var(--rule); background: var(--panel); }
figcaption { font-size: .8rem; line-height: 1.35; color: var(--soft); margin-top: .3rem;
  overflow-wrap: anywhere; }
pre { background: var(--panel); border: 1px solid var(--rule); padding: .5rem .75rem; margin: .4rem 0;
  overflow-x: auto; font: .85rem/1.45 ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
ul { margin: .4rem 0; padding-left: 1.2rem; } li { margin: .15rem 0; overflow-wrap: anywhere; }
@media (max-width: 40rem) { main { padding: 1.2rem .8rem 3rem; } th, td { padding: .25rem .35rem; }
  .facts { grid-template-columns: 1fr; } .facts dd { margin-bottom: .35rem; } }
@page { margin: 15mm; }
@media print { :root { color-scheme: light; --paper: #fff; --ink: #000; --soft: #444; --rule: #bbb;
    --rule-strong: #000; --panel: #fff; --link: #000; --holds: #000; --fails: #000;
    --ambiguous: #000; --unmeasured: #000; --not-applicable: #000; --holds-bg: #eee;
    --fails-bg: #fff; --ambiguous-bg: #fff; --unmeasured-bg: #fff; }
  body { font-size: 10pt; } .results { font-size: 7.5pt; } .results th, .results td { padding: 2pt 3pt; }
  main { max-width: none; padding: 0; } .scroll { overflow: visible; }
  tr, figure { break-inside: avoid; } h2, h3 { break-after: avoid; }
  .fails { border-color: #000; } section { margin-top: 1.6rem; } }
)css";
}

}  // namespace gfxrepro::report
