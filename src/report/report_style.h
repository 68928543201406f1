#pragma once

namespace fcn {

/// The report's style sheet: system fonts, light, tables that scroll sideways on narrow screens.
inline constexpr const char* kReportStyle = R"css(
:root { color-scheme: light; --ink: #1d2733; --soft: #5b6878; --line: #dde3ea; --panel: #fff;
        --ground: #f4f6f9; --accent: #1f4f8f; --good: #15693b; --bad: #a3232b; }
* { box-sizing: border-box; }
body { margin: 0; font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif;
       color: var(--ink); background: var(--ground); }
header, main, footer { max-width: 84rem; margin: 0 auto; padding: 1rem clamp(0.8rem, 3vw, 2rem); }
header { padding-top: 2rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 0.4rem; }
h2 { font-size: 1.45rem; line-height: 1.25; margin: 0 0 0.6rem; }
h3 { font-size: 1.15rem; margin: 1.8rem 0 0.5rem; padding-top: 1.2rem;
     border-top: 1px solid var(--line); }
p { margin: 0.4rem 0; max-width: 75ch; }
code { font: 0.9em ui-monospace, SFMono-Regular, Consolas, monospace; overflow-wrap: anywhere; }
a { color: var(--accent); }
a:focus-visible, summary:focus-visible, .scroll:focus-visible {
  outline: 3px solid #f0a92e; outline-offset: 2px; border-radius: 3px; }
nav ul { display: flex; flex-wrap: wrap; gap: 0.3rem 1.2rem; list-style: none; padding: 0;
         margin: 0.8rem 0 0; }
section { background: var(--panel); border: 1px solid var(--line); border-radius: 10px;
          padding: clamp(0.9rem, 2.5vw, 1.6rem); margin: 0 0 1.4rem; }
.facts { color: var(--soft); }
.badges { display: flex; flex-wrap: wrap; gap: 0.4rem; list-style: none; padding: 0;
          margin: 0.5rem 0; }
.badges li { border: 1px solid var(--line); border-radius: 999px; padding: 0.1rem 0.8rem;
             background: var(--ground); font-size: 0.92rem; }
.badges .good { color: var(--good); border-color: currentColor; }
.badges .bad { color: var(--bad); border-color: currentColor; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(21rem, 100%), 1fr));
           gap: 1rem; margin: 0.8rem 0; }
figure { margin: 0; min-width: 0; }
figure.single { max-width: 42rem; }
figure img { display: block; width: 100%; height: auto; border: 1px solid var(--line);
             border-radius: 6px; }
figcaption { font-size: 0.92rem; color: var(--soft); margin-top: 0.35rem; }
.key { white-space: nowrap; margin-right: 0.8rem; }
.key i { display: inline-block; width: 1.6em; height: 0.32em; border-radius: 2px;
         vertical-align: middle; margin-right: 0.35em; }
.scroll { overflow-x: auto; margin: 0.7rem 0; }
table { border-collapse: collapse; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
caption { text-align: left; font-weight: 600; padding-bottom: 0.3rem; white-space: nowrap; }
th, td { padding: 0.28rem 0.7rem; border-bottom: 1px solid var(--line); vertical-align: top; }
thead th { color: var(--soft); font-weight: 600; vertical-align: bottom;
           border-bottom: 2px solid var(--line); }
tbody th { font-weight: 400; }
tbody th:first-child:last-of-type { min-width: 14rem; }
.text { text-align: left; }
.number { text-align: right; white-space: nowrap; }
tr.emphasized > * { font-weight: 600; }
tbody tr:hover { background: #f3f7fc; }
details { border: 1px solid var(--line); border-radius: 6px; padding: 0.4rem 0.9rem;
          margin: 0.6rem 0; }
summary { cursor: pointer; font-weight: 600; }
ul.messages { margin: 0.4rem 0; padding-left: 1.2rem; }
@media print { body { background: #fff; } section { border: 0; padding: 0; } }
)css";

}  // namespace fcn
