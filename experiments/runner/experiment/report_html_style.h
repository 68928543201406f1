#pragma once

namespace experiment {

/// Style sheet of the report.
inline constexpr const char* kReportStyle = R"css(
:root { color-scheme: light dark; --ink: #1c2128; --dim: #59636e; --paper: #ffffff;
  --line: #d1d9e0; --band: #f6f8fa; --link: #0a5cc0; --good: #0b6e4f; --alarm: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e8eb; --dim: #9aa4af; --paper: #16191d;
  --line: #363c44; --band: #1e2329; --link: #7cb7ff; --good: #6fd3ac; --alarm: #ff8a80; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1180px; padding: 28px 24px 80px; background: var(--paper);
  color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 26px; margin: 0 0 4px; }
h2 { font-size: 19px; margin: 40px 0 10px; padding-top: 10px; border-top: 1px solid var(--line); }
p { max-width: 78ch; margin: 8px 0; }
ul { max-width: 90ch; margin: 8px 0; padding-left: 22px; }
a { color: var(--link); text-decoration: none; }
a:hover { text-decoration: underline; }
.lead { color: var(--dim); font-size: 16px; max-width: 90ch; }
nav { margin: 14px 0 0; display: flex; flex-wrap: wrap; gap: 4px 16px; font-size: 14px; }
pre { background: var(--band); border: 1px solid var(--line); border-radius: 6px;
  padding: 8px 12px; overflow-x: auto; font-size: 13px; }
.sheet { overflow-x: auto; margin: 6px 0 18px; border: 1px solid var(--line);
  border-radius: 6px; }
details .sheet { max-height: 620px; overflow-y: auto; }
table { border-collapse: collapse; font-size: 13.5px; font-variant-numeric: tabular-nums;
  width: 100%; }
th { position: sticky; top: 0; background: var(--band); text-align: left; cursor: pointer;
  border-bottom: 1px solid var(--line); vertical-align: bottom; padding: 6px 10px;
  font-weight: 600; }
th.n, td.n { text-align: right; }
td { padding: 4px 10px; border-bottom: 1px solid var(--line); }
td.n, td:first-child { white-space: nowrap; }
tr:last-child td { border-bottom: none; }
tbody tr:hover td { background: var(--band); }
td.best { font-weight: 700; color: var(--good); }
th.up::after { content: " ▲"; } th.down::after { content: " ▼"; }
.caption { color: var(--dim); font-size: 13.5px; margin: 14px 0 2px; max-width: 110ch; }
summary { cursor: pointer; margin: 12px 0 4px; color: var(--link); }
.figures { display: grid; gap: 18px; margin: 12px 0;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 500px), 1fr)); }
figure { margin: 0; border: 1px solid var(--line); border-radius: 6px; padding: 10px;
  background: #ffffff; }
figure img { width: 100%; height: auto; display: block; }
figcaption { color: #59636e; font-size: 13px; margin-top: 6px; }
.alarm { background: var(--alarm); color: var(--paper); padding: 14px 18px; border-radius: 6px;
  font-weight: 600; font-size: 16px; max-width: none; }
.alarm-list li { color: var(--alarm); }
@media print { details .sheet { max-height: none; overflow: visible; } body { max-width: none; } }
)css";

/// Sorts a table by the column whose head is clicked: numbers by their value, cells without one
/// always last. Written without < > &, so that the page is well-formed for any reader.
inline constexpr const char* kReportScript = R"js(
document.querySelectorAll("th").forEach(function (head) {
  head.addEventListener("click", function () {
    var table = head.closest("table"), body = table.tBodies[0];
    var column = head.cellIndex, down = head.classList.contains("up");
    table.querySelectorAll("th").forEach(function (h) { h.classList.remove("up", "down"); });
    head.classList.add(down ? "down" : "up");
    var sign = down ? -1 : 1;
    function number(row) {
      var value = row.cells[column].getAttribute("data-n");
      return value === null ? NaN : Number(value);
    }
    Array.from(body.rows).sort(function (a, b) {
      if (head.classList.contains("n")) {
        var x = number(a), y = number(b);
        if (isNaN(x) || isNaN(y)) return Number(isNaN(x)) - Number(isNaN(y));
        return x === y ? 0 : sign * Math.sign(x - y);
      }
      return sign * a.cells[column].textContent.localeCompare(b.cells[column].textContent);
    }).forEach(function (row) { body.appendChild(row); });
  });
});
)js";

}  // namespace experiment
