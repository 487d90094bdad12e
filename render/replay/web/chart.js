"use strict";
// Clearance over time of all traces, with what happened, and a cursor that can be dragged.
const ReplayChart = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const LEFT = 48, RIGHT = 12, TOP = 10, BOTTOM = 24;

  function add(parent, name, attributes, text) {
    const element = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    parent.appendChild(element);
    return element;
  }

  // 1, 2 or 5 times a power of ten: about `count` steps in all.
  function niceStep(span, count) {
    const rough = span / count, power = Math.pow(10, Math.floor(Math.log10(rough)));
    return power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
  }

  return class {
    // `seek(t)` is called when the cursor is dragged.
    constructor(parent, traces, lineColors, seek) {
      this.traces = traces;
      this.lineColors = lineColors;
      this.end = Math.max(...traces.map((trace) => trace.end), 1e-3);
      this.svg = add(parent, "svg", {class: "replay-chart", role: "img",
                                     "aria-label": "Clearance over time"});
      this.t = 0;
      const move = (event) => {
        const box = this.svg.getBoundingClientRect();
        seek(this.timeAt(event.clientX - box.left));
      };
      this.svg.addEventListener("pointerdown", (event) => {
        this.svg.setPointerCapture(event.pointerId);
        move(event);
      });
      this.svg.addEventListener("pointermove", (event) => {
        if (event.buttons) move(event);
      });
      this.draw();
    }

    x(t) { return LEFT + (this.width - LEFT - RIGHT) * t / this.end; }
    timeAt(x) {
      const share = (x - LEFT) / (this.width - LEFT - RIGHT);
      return this.end * Math.min(1, Math.max(0, share));
    }
    y(d) { return TOP + (this.height - TOP - BOTTOM) * (this.high - d) / (this.high - this.low); }

    range() {
      let low = 0, high = 0.05;
      for (const {clearance: {d}, margin} of this.traces) {
        for (const value of d) {
          if (!Number.isFinite(value)) continue;
          low = Math.min(low, value);
          high = Math.max(high, value);
        }
        if (margin) high = Math.max(high, 1.2 * margin);
      }
      this.low = low < 0 ? 1.1 * low : 0;
      this.high = 1.06 * high;
    }

    draw() {
      this.width = Math.max(240, this.svg.clientWidth || 600);
      this.height = Math.max(100, this.svg.clientHeight || 150);
      this.svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
      this.svg.textContent = "";
      this.range();
      this.drawAxes();
      if (this.traces.some((trace) => trace.clearance.d.length)) {
        this.traces.forEach((trace, i) => this.drawTrace(trace, this.lineColors[i]));
      } else {
        add(this.svg, "text", {x: (LEFT + this.width) / 2, y: this.height / 2 - 6, class: "hint",
                               "text-anchor": "middle"}, "nobody knows the true clearance of these traces");
      }
      this.cursor = add(this.svg, "g", {class: "cursor"});
      add(this.cursor, "line", {y1: TOP, y2: this.height - BOTTOM});
      this.dots = this.traces.map((trace, i) =>
          add(this.svg, "circle", {r: 4, fill: this.lineColors[i], class: "dot"}));
      this.moveTo(this.t);
    }

    drawAxes() {
      const right = this.width - RIGHT, bottom = this.height - BOTTOM;
      const step = niceStep(this.high - this.low, Math.max(2, this.height / 38));
      for (let n = Math.ceil(this.low / step); n * step <= this.high; ++n) {
        const y = this.y(n * step);
        add(this.svg, "line", {x1: LEFT, x2: right, y1: y, y2: y, class: n === 0 ? "zero" : "grid"});
        add(this.svg, "text", {x: LEFT - 6, y: y + 4, "text-anchor": "end"},
            String(Math.round(n * step * 1000)));
      }
      const stepT = niceStep(this.end, Math.max(2, this.width / 90));
      for (let n = 0; n * stepT <= this.end * 1.0001; ++n) {
        const x = this.x(n * stepT);
        const last = (n + 1) * stepT > this.end * 1.0001;
        add(this.svg, "line", {x1: x, x2: x, y1: bottom, y2: bottom + 4, class: "axis"});
        add(this.svg, "text", {x, y: bottom + 17, "text-anchor": "middle"},
            String(Number((n * stepT).toFixed(3))) + (last ? " s" : ""));
      }
      add(this.svg, "line", {x1: LEFT, x2: right, y1: bottom, y2: bottom, class: "axis"});
      add(this.svg, "text", {x: -this.height / 2 + BOTTOM / 2, y: 11, transform: "rotate(-90)",
                             "text-anchor": "middle"}, "clearance, mm");
    }

    drawTrace(trace, color) {
      const {t, d} = trace.clearance;
      if (trace.margin && trace === this.traces.find((other) => other.margin)) {
        const y = this.y(trace.margin);
        add(this.svg, "line", {x1: LEFT, x2: this.width - RIGHT, y1: y, y2: y, class: "margin"});
        add(this.svg, "text", {x: this.width - RIGHT, y: y - 4, "text-anchor": "end", class: "hint"},
            "safety margin of the planner");
      }
      for (const [begin, last] of this.spansOf(trace.touches)) {
        add(this.svg, "rect", {x: this.x(begin), width: Math.max(2, this.x(last) - this.x(begin)),
                               y: TOP, height: this.height - TOP - BOTTOM, class: "touch"});
      }
      let path = "", isBroken = true;
      for (let i = 0; i < t.length; ++i) {
        if (!Number.isFinite(d[i])) {
          isBroken = true;
          continue;
        }
        path += `${isBroken ? "M" : "L"}${this.x(t[i]).toFixed(1)} ${this.y(d[i]).toFixed(1)}`;
        isBroken = false;
      }
      add(this.svg, "path", {d: path, fill: "none", stroke: color, "stroke-width": 1.8});
      for (const [at, what, kind] of trace.marks) {
        if (kind === "track") continue;  // there may be many: they are listed
        const mark = add(this.svg, "circle", {cx: this.x(at), cy: this.height - BOTTOM, r: 3.5,
                                              class: "mark " + kind});
        add(mark, "title", {}, `${at.toFixed(2)} s: ${what}`);
      }
    }

    // Touches that follow one another within a twentieth of a second, as one.
    spansOf(touches) {
      const spans = [];
      for (const [t] of touches) {
        const latest = spans[spans.length - 1];
        if (latest && t - latest[1] < 0.05) latest[1] = t;
        else spans.push([t, t]);
      }
      return spans;
    }

    moveTo(t) {
      this.t = t;
      this.cursor.setAttribute("transform", `translate(${this.x(Math.min(t, this.end))} 0)`);
      this.traces.forEach((trace, i) => {
        const d = t <= trace.end + 1e-9 ? trace.clearanceAt(t) : null;
        const isKnown = Number.isFinite(d);
        this.dots[i].setAttribute("visibility", isKnown ? "visible" : "hidden");
        if (!isKnown) return;
        this.dots[i].setAttribute("cx", this.x(t));
        this.dots[i].setAttribute("cy", this.y(d));
      });
    }
  };
})();
