#include "app/report/style.hpp"

namespace flyball {

std::string_view report_style() {
  return R"(
:root {
  color-scheme: light dark;
  --page: #ffffff; --raised: #f5f6f8; --text: #1c2128; --dim: #59636e; --line: #d9dee4; --link: #0b5cad;
  --good: #1a7f37; --bad: #b3261e; --open: #8a5a00;
}
.dark { display: none; }
@media (prefers-color-scheme: dark) {
  :root {
    --page: #15181c; --raised: #1e2329; --text: #e4e8ec; --dim: #9aa5b1; --line: #343c45; --link: #6db3f2;
    --good: #57c271; --bad: #ff8a80; --open: #e3b341;
  }
  .light { display: none; }
  .dark { display: block; }
}
* { box-sizing: border-box; }
html { scroll-behavior: smooth; }
body {
  margin: 0 auto; padding: 2.5rem 1.25rem 4rem; max-width: 54rem;
  background: var(--page); color: var(--text);
  font: 1rem/1.55 Inter, system-ui, -apple-system, "Segoe UI", "Helvetica Neue", "DejaVu Sans", Arial, sans-serif;
  font-variant-numeric: tabular-nums;
}
h1 { margin: 0; font-size: 2.1rem; line-height: 1.2; letter-spacing: -0.015em; overflow-wrap: anywhere; }
h2 {
  margin: 3rem 0 0.9rem; padding-top: 0.9rem; border-top: 1px solid var(--line);
  font-size: 1.4rem; line-height: 1.25; letter-spacing: -0.01em;
}
h3 { margin: 1.9rem 0 0.6rem; font-size: 1.02rem; line-height: 1.35; overflow-wrap: anywhere; }
p { margin: 0.6rem 0; max-width: 44rem; overflow-wrap: anywhere; }
a { color: var(--link); text-decoration: none; }
a:hover { text-decoration: underline; }
.kicker { margin: 0 0 0.3rem; color: var(--dim); font-size: 0.9rem; }
.description { color: var(--dim); white-space: pre-line; }
.lead { font-size: 1.06rem; }
.refusal { padding: 0.8rem 1rem; border-left: 4px solid var(--bad); background: var(--raised); }
.verdict { display: flex; flex-wrap: wrap; gap: 0.2rem 0.9rem; margin: 1.2rem 0 0; font-weight: 600; }
.good { color: var(--good); }
.bad { color: var(--bad); }
.open { color: var(--open); }
.note, figcaption { color: var(--dim); font-size: 0.9rem; }
nav { margin: 1.8rem 0; padding: 0.9rem 1.2rem; border-radius: 8px; background: var(--raised); }
nav h2 { margin: 0 0 0.4rem; padding: 0; border: 0; font-size: 0.95rem; letter-spacing: 0; }
nav ol { margin: 0; padding-left: 1.4rem; columns: 3 13rem; }
nav li { padding: 0.1rem 0; break-inside: avoid; }
nav li::marker { color: var(--dim); }
figure { margin: 1rem 0 1.6rem; }
figcaption { margin-top: 0.4rem; max-width: 44rem; overflow-wrap: anywhere; }
img, svg { display: block; width: 100%; height: auto; border: 1px solid var(--line); border-radius: 6px; }
img.dark { display: none; }
@media (prefers-color-scheme: dark) { img.light { display: none; } img.dark { display: block; } }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 0.9rem; line-height: 1.4; }
th, td { padding: 0.35rem 0.9rem 0.35rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
th:last-child, td:last-child { padding-right: 0; }
thead th { color: var(--dim); font-weight: 600; vertical-align: bottom; border-bottom-color: var(--dim); }
tbody th { font-weight: 500; min-width: 3rem; max-width: 22rem; overflow-wrap: anywhere; }
.columns .wide { overflow: visible; columns: 2 20rem; column-gap: 2.5rem; }
.columns tr { break-inside: avoid; }
td.words { min-width: 8rem; overflow-wrap: anywhere; }
.number { text-align: right; white-space: nowrap; }
dl { display: grid; grid-template-columns: minmax(8rem, max-content) 1fr; gap: 0.4rem 1.4rem; margin: 0.8rem 0; }
dt { color: var(--dim); }
dd { margin: 0; overflow-wrap: anywhere; }
ul { margin: 0.5rem 0; padding-left: 1.3rem; max-width: 44rem; }
li { overflow-wrap: anywhere; }
sup { font-size: 0.72em; line-height: 0; }
@media (max-width: 36rem) {
  body { padding-top: 1.4rem; }
  h1 { font-size: 1.6rem; }
  dl { grid-template-columns: 1fr; gap: 0; }
  dd { margin-bottom: 0.6rem; }
}
@page { margin: 18mm 16mm; }
@media print {
  :root {
    color-scheme: light;
    --page: #ffffff; --raised: #ffffff; --text: #000000; --dim: #444444; --line: #c8c8c8; --link: #000000;
    --good: #10602a; --bad: #98201a; --open: #6d4700;
  }
  html { font-size: 10pt; }
  body { max-width: none; padding: 0; }
  .light, img.light { display: block; }
  .dark, img.dark { display: none; }
  h2, h3, thead, section > p { break-after: avoid; }
  figure, tr, dt, dd, .verdict { break-inside: avoid; }
  .wide { overflow: visible; }
  nav { padding: 0; }
  th, td { padding-right: 0.6rem; }
  .number { white-space: normal; }
}
)";
}

} // namespace flyball
