// SPDX-License-Identifier: Apache-2.0
#include "services/ctl/report/style.hpp"

namespace pursuit::ctl {

const std::string_view report_style = R"css(
:root { color-scheme: light dark;
  --page: #f6f6f3; --card: #ffffff; --ink: #1c1e21; --soft: #5f646b; --line: #dddcd6;
  --good: #1a7f4b; --good-bg: #e3f4ea; --bad: #b42318; --bad-bg: #fdecea; --truth: #8b9097;
  --c0: #d6400b; --c1: #0a7d6d; --c2: #7a3fd1; --c3: #c01f6a; --c4: #8a6a00; --c5: #1f66c7;
  --c6: #4d7c0f; --c7: #7c4a2d; --occluded: #f0c24b55; --lost: #d9363630; }
@media (prefers-color-scheme: dark) { :root {
  --page: #14161a; --card: #1d2025; --ink: #e8e8e6; --soft: #9ba1a9; --line: #33373e;
  --good: #5fd093; --good-bg: #16351f; --bad: #ff8a80; --bad-bg: #43201d; --truth: #8d949d;
  --c0: #ff8a50; --c1: #3fd0ba; --c2: #b493ff; --c3: #ff7fb2; --c4: #e3bd3c; --c5: #74adff;
  --c6: #a3d65c; --c7: #d8a27e; --occluded: #c9951f40; --lost: #e0454538; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 20px 60px; }
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 17px; margin: 36px 0 10px; }
p { margin: 4px 0; } .soft, figcaption, .unit { color: var(--soft); }
.verdict { display: inline-block; margin: 14px 0 6px; padding: 6px 14px; border-radius: 8px;
  font-weight: 600; font-size: 17px; }
.good { color: var(--good); } .bad { color: var(--bad); }
.verdict.good { background: var(--good-bg); } .verdict.bad { background: var(--bad-bg); }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px;
  padding: 14px 16px; }
.chips { display: flex; flex-wrap: wrap; gap: 12px; margin-top: 10px; }
.chip { flex: 1 1 240px; border-left: 5px solid var(--own); }
.chip b { display: block; font-size: 16px; } .chip .big { font-size: 22px; font-weight: 600; }
.o0 { --own: var(--c0); } .o1 { --own: var(--c1); } .o2 { --own: var(--c2); }
.o3 { --own: var(--c3); } .o4 { --own: var(--c4); } .o5 { --own: var(--c5); }
.o6 { --own: var(--c6); } .o7 { --own: var(--c7); }
.defs { position: absolute; width: 0; height: 0; }
.film { display: grid; grid-template-columns: repeat(auto-fill, minmax(170px, 1fr)); gap: 10px;
  margin-top: 10px; }
figure { margin: 0; } figcaption { font-size: 12px; font-variant-numeric: tabular-nums; }
.frame svg, .viewer svg { display: block; width: 100%; background: var(--card);
  border: 1px solid var(--line); border-radius: 6px; }
.frame { cursor: pointer; border-radius: 6px; }
.frame.now svg { outline: 2px solid var(--ink); outline-offset: -1px; }
.viewer { display: none; } .viewer svg { max-height: 72vh; }
.viewer figcaption { font-size: 14px; margin-top: 4px; }
.play { display: flex; gap: 12px; align-items: center; margin-top: 8px; }
.play input { flex: 1; accent-color: var(--ink); }
.play button { font: inherit; color: inherit; background: var(--page); cursor: pointer;
  border: 1px solid var(--line); border-radius: 6px; padding: 3px 14px; min-width: 84px; }
.events { image-rendering: pixelated; }
use { fill: none; stroke-linecap: round; stroke-linejoin: round; }
.found { stroke: var(--own); stroke-width: 1.9px; } .frame .found { stroke-width: 1.5px; }
.occluded { stroke-dasharray: 5 5; } .trail { stroke: var(--own); stroke-width: 1px; opacity: .55; }
.truth { stroke: var(--truth); stroke-width: 1.2px; stroke-dasharray: 1 4; }
.plots { display: grid; margin-bottom: 10px; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 8px 18px; }
.plot { display: block; width: 100%; font-size: 11px; }
.plot text { fill: var(--soft); font-variant-numeric: tabular-nums; }
.plot .title { fill: var(--ink); font-size: 12.5px; font-weight: 600; } .plot .unit { font-weight: 400; }
.plot .value { text-anchor: end; } .plot .time, .plot .none { text-anchor: middle; }
.plot .grid { stroke: var(--line); stroke-width: 1; } .plot .axis { stroke: var(--soft); }
.plot .cursor { stroke: var(--ink); stroke-width: 1; opacity: .6; }
.curve { fill: none; stroke-width: 1.7; stroke-linejoin: round; stroke: var(--own); }
.curve.true { stroke: var(--truth); stroke-width: 4; opacity: .55; }
.shade-occluded { fill: var(--occluded); } .shade-lost { fill: var(--lost); }
.key { display: flex; flex-wrap: wrap; gap: 4px 18px; font-size: 13px; color: var(--soft);
  margin: 6px 0; }
.key i { display: inline-block; width: 22px; height: 0; border-top: 3px solid var(--own, var(--truth));
  vertical-align: middle; margin-right: 6px; }
.key i.box { height: 12px; border: 0; border-radius: 2px; } .key i.on { background: #3e74b2; }
.key i.off { background: #b07c54; } .key i.dots { border-top: 2px dotted var(--truth); }
.key i.dash { border-top: 2px dashed var(--soft); }
.key i.box.shade-occluded { background: var(--occluded); } .key i.box.shade-lost { background: var(--lost); }
.wide { overflow-x: auto; } table { border-collapse: collapse; width: 100%; font-size: 14px; }
th { text-align: left; font-weight: 600; color: var(--soft); font-size: 13px; }
th, td { padding: 5px 14px 5px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; }
.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.facts th { width: 26%; } .facts td { white-space: pre-wrap; overflow-wrap: anywhere; font-size: 13px; }
.two { display: grid; grid-template-columns: repeat(auto-fit, minmax(330px, 1fr)); gap: 14px; align-items: start; }
)css";

const std::string_view report_script = R"js(
(function () {
  var frames = Array.prototype.slice.call(document.querySelectorAll('.frame'));
  var viewer = document.getElementById('viewer');
  if (!frames.length || !viewer) return;
  var picture = document.getElementById('picture');
  var caption = document.getElementById('caption');
  var slider = document.getElementById('slider');
  var button = document.getElementById('play');
  var cursors = document.querySelectorAll('.cursor');
  var now = 0, timer = null;
  function show(index) {
    frames[now].classList.remove('now');
    now = index;
    var frame = frames[now];
    frame.classList.add('now');
    picture.replaceChildren(frame.querySelector('svg').cloneNode(true));
    caption.textContent = frame.querySelector('figcaption').textContent;
    slider.value = now;
    var time = Number(frame.dataset.time);
    cursors.forEach(function (line) {
      var d = line.dataset;
      var part = (time - Number(d.begin)) / (Number(d.end) - Number(d.begin));
      var x = part >= 0 && part <= 1 ? Number(d.left) + part * (Number(d.right) - Number(d.left)) : -9;
      line.setAttribute('x1', x);
      line.setAttribute('x2', x);
    });
  }
  function stop() { clearInterval(timer); timer = null; button.textContent = 'Play'; }
  function pick(index) { stop(); show(index); }
  frames.forEach(function (frame, index) {
    frame.addEventListener('click', function () { pick(index); });
    frame.addEventListener('keydown', function (e) { if (e.key === 'Enter') pick(index); });
  });
  slider.max = frames.length - 1;
  slider.addEventListener('input', function () { pick(Number(slider.value)); });
  button.addEventListener('click', function () {
    if (timer) return stop();
    button.textContent = 'Stop';
    timer = setInterval(function () { show((now + 1) % frames.length); }, 250);
  });
  viewer.style.display = 'block';
  show(Math.floor(frames.length / 2));
})();
)js";

}  // namespace pursuit::ctl
