"use strict";
// Shows traces side by side and in step, in `root`: a picture of each in three dimensions, their
// clearance over time, and what moves them through time. `data` is what ReplayJson writes.
//
// Returns what scripts can use: seek(t), play(), pause(), toggle(layer, on), state(), render().
function mountReplay(root, data, options = {}) {
  const LINE_COLORS = ["#2f7ff0", "#e0832f", "#2f9e6e", "#b457d8", "#d0475b", "#7c8a1e"];
  const SPEEDS = [0.1, 0.25, 0.5, 1, 2];
  const THEMES = {
    light: {sky: "#dfe6ee", floor: ["#c3c9d0", "#b6bdc5"]},
    dark: {sky: "#1b2028", floor: ["#39414c", "#323a44"]},
  };

  const traces = data.traces.map((trace) => new ReplayData.Trace(trace));
  const end = Math.max(...traces.map((trace) => trace.end));
  const fields = traces.map((trace) => trace.field).filter((field) => field.cycles > 0);
  let isDue = false;  // a frame has been asked for
  const state = {t: 0, playing: false, speed: 1, theme: null};
  const show = {trail: true, plan: true, prediction: true, spheres: false, field: false,
                layer: 0, ahead: 0};
  if (fields.length) show.layer = fields[0].layerAt(0.6);

  function make(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
      if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
      else if (value !== false) element.setAttribute(key, value === true ? "" : value);
    }
    element.append(...children);
    return element;
  }

  // --- The page ---------------------------------------------------------------------------------

  root.textContent = "";
  root.classList.add("replay");
  const clock = make("output", {class: "clock"});
  const themeButton = make("button", {
    type: "button", title: "Light or dark (D)", "aria-label": "Light or dark",
    onclick: () => setTheme(themeNow() === "dark" ? "light" : "dark"),
  }, "◐");
  const scenario = (traces[0].facts.find(([name]) => name === "scenario") || ["", traces[0].name])[1];
  // Which case it is: what all traces share here, what tells them apart above each.
  const factOf = (trace, key) => (trace.facts.find(([name]) => name === key) || ["", ""])[1];
  const caseFacts = ["seed", "speed"].map((key) => ({
    text: (trace) => factOf(trace, key) && (key === "seed" ? "seed " : "") + factOf(trace, key),
    shared: traces.every((trace) => factOf(trace, key) === factOf(traces[0], key)),
  }));
  const shared = caseFacts.filter((fact) => fact.shared).map((fact) => fact.text(traces[0]));
  const header = make("header", {}, make(options.embedded ? "h3" : "h1", {},
                                         [scenario, ...shared].filter(Boolean).join(", ")), clock);
  if (!options.embedded) header.append(themeButton);

  const canvas = make("canvas", {role: "img",
                                 "aria-label": "The robot and what moves around it, in three dimensions"});
  const panels = traces.map((trace, i) => {
    const swatch = make("span", {class: "swatch", style: `background:${LINE_COLORS[i % 6]}`});
    const title = make("div", {class: "panel-title"}, swatch, make("b", {}, trace.title),
                       make("span", {class: "explanation"},
                            [...caseFacts.filter((fact) => !fact.shared).map((fact) => fact.text(trace)),
                             trace.explanation].filter(Boolean).join(", ")));
    const words = make("span"), speed = make("span", {class: "speed"});
    const status = make("div", {class: "panel-status"}, words, speed);
    const view = make("div", {class: "panel-view"});
    const element = make("div", {class: "panel"}, title, view, status);
    if (trace.place) view.append(make("span", {class: "place"}, trace.place));
    return {element, view, status, words, speed, trace};
  });
  const stage = make("div", {class: "stage", "data-count": String(traces.length)}, canvas,
                     ...panels.map((panel) => panel.element));

  const playButton = make("button", {type: "button", class: "play", title: "Play or pause (space)",
                                     onclick: () => (state.playing ? pause() : play())});
  const slider = make("input", {type: "range", min: 0, max: end, step: 0.001, value: 0,
                                "aria-label": "Time", oninput: () => {
                                  pause();
                                  seek(Number(slider.value));
                                }});
  const speedChoice = make("select", {"aria-label": "Speed",
                                      onchange: () => { state.speed = Number(speedChoice.value); }},
      ...SPEEDS.map((speed) => make("option", {value: speed, selected: speed === 1}, `${speed}×`)));
  const stepButton = (text, title, dt) => make("button", {
    type: "button", title, "aria-label": title, onclick: () => { pause(); seek(state.t + dt); }}, text);
  const transport = make("div", {class: "transport"}, playButton,
                         stepButton("‹", "Back by 0.02 s (left arrow)", -0.02),
                         stepButton("›", "On by 0.02 s (right arrow)", 0.02), slider, speedChoice);

  const layerBoxes = {};
  const hasSpheres = traces.some((trace) => trace.spheres.radii.length);
  const layer = (name, text, color, enabled = true, why = "") => {
    const box = make("input", {type: "checkbox", checked: show[name] && enabled, disabled: !enabled,
                               onchange: () => toggle(name, box.checked)});
    layerBoxes[name] = box;
    return make("label", {title: why}, box, make("span", {class: "swatch", style: `background:${color}`}),
                text);
  };
  const whyNoSpheres = (traces.find((trace) => trace.spheres.whyNone) || {spheres: {}}).spheres.whyNone;
  const whyNoField = (traces.find((trace) => trace.field.whyNone) || {field: {}}).field.whyNone;
  const layers = make("div", {class: "layers"},
      layer("trail", "path so far", data.colors.trail),
      layer("plan", "planned path", data.colors.plan),
      layer("prediction", "predicted obstacle", data.colors.prediction),
      layer("spheres", "planner’s spheres", "#19a7b8", hasSpheres, whyNoSpheres || ""),
      layer("field", "planner’s field", "linear-gradient(90deg,#7a1a1f,#fa8533,#b8d6fa)",
            fields.length > 0, whyNoField || ""));
  const fieldNote = make("span", {class: "field-note"});
  const heightSlider = make("input", {type: "range", min: 0, max: fields.length ? fields[0].size[2] - 1 : 0,
                                      step: 1, value: show.layer, "aria-label": "Height of the slice",
                                      oninput: () => { show.layer = Number(heightSlider.value); draw(); }});
  const aheadChoice = make("select", {"aria-label": "How far ahead", onchange: () => {
    show.ahead = Number(aheadChoice.value);
    draw();
  }}, ...(fields.length ? fields[0].ahead : []).map((ahead, i) =>
      make("option", {value: i}, ahead === 0 ? "as seen" : `${ahead} s ahead`)));
  const fieldControls = make("div", {class: "field-controls", hidden: true},
                             make("label", {}, "height ", heightSlider), aheadChoice, fieldNote);
  const views = make("div", {class: "views"}, "view",
      ...[["chosen", () => lookFrom(data.view.eye)],
          ["top", () => lookFrom(above(0.001, 0, 1))],
          ["front", () => lookFrom(above(1, 0, 0.25))],
          ["side", () => lookFrom(above(0, -1, 0.25))]].map(
          ([name, act]) => make("button", {type: "button", onclick: act}, name)));

  const chartBox = make("div", {class: "chart-box"});
  const about = make("div", {class: "about"});
  root.append(header, stage, make("div", {class: "panel-bar"}, transport, chartBox, layers,
                                  fieldControls, views), about);
  const chart = new ReplayChart(chartBox, traces, LINE_COLORS, (t) => { pause(); seek(t); });
  fillAbout();

  // What the runs were, what happened, and which keys there are.
  function fillAbout() {
    const names = [];
    for (const trace of traces) {
      for (const [name] of trace.facts) if (!names.includes(name)) names.push(name);
    }
    const valueOf = (trace, name) => (trace.facts.find(([other]) => other === name) || ["", ""])[1];
    const head = make("tr", {}, make("th", {}), ...traces.map((trace) => make("th", {}, trace.title)));
    const rows = names.map((name) => make("tr", {}, make("th", {}, name),
        ...traces.map((trace) => make("td", {}, valueOf(trace, name)))));
    about.append(make("details", {open: true}, make("summary", {}, "The runs"),
                      make("div", {class: "scroll"}, make("table", {}, head, ...rows))));
    const notes = [whyNoSpheres && `The planner’s spheres are left out: ${whyNoSpheres}.`,
                   whyNoField && `The planner’s field is left out: ${whyNoField}.`].filter(Boolean);
    for (const note of notes) about.append(make("p", {class: "note"}, note));
    const marks = traces.flatMap((trace) => trace.marks.map((mark) => [...mark, trace.title]));
    marks.sort((a, b) => a[0] - b[0]);
    if (marks.length) {
      about.append(make("details", {}, make("summary", {}, `What happened (${marks.length})`),
          make("ul", {class: "marks"}, ...marks.slice(0, 500).map(([t, what, kind, title]) =>
              make("li", {}, make("button", {type: "button", class: "mark-time " + kind,
                                             onclick: () => { pause(); seek(t); }}, t.toFixed(2) + " s"),
                   " " + what + (traces.length > 1 ? ` (${title})` : ""))))));
    }
    about.append(make("details", {}, make("summary", {}, "Keys and gestures"), make("p", {},
        "Space plays and pauses. Left and right step by 0.02 s, with shift by 0.1 s; Home and End " +
        "go to the ends; < and > change the speed. P, T, O, S, F show or hide the planned path, the " +
        "path so far, the predicted obstacle, the spheres and the field; up and down move the field. " +
        "1 to 4 choose a view, D light or dark. Drag (one finger) turns the view, the wheel (two " +
        "fingers) comes nearer, dragging with the right button (two fingers) shifts it.")));
  }

  // --- Three dimensions -------------------------------------------------------------------------

  let renderer = null, camera = null, controls = null, scenes = [];
  try {
    renderer = new THREE.WebGLRenderer(
        {canvas, antialias: true, alpha: true, powerPreference: "high-performance"});
  } catch (error) {
    stage.append(make("p", {class: "no-webgl"},
                      "This browser does not draw in three dimensions (WebGL is off)."));
  }
  if (renderer) {
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    camera = new THREE.PerspectiveCamera(data.view.field_of_view_rad * 180 / Math.PI, 1, 0.05, 60);
    camera.up.set(0, 0, 1);
    controls = new THREE.OrbitControls(camera, stage);
    controls.enableKeys = false;
    controls.screenSpacePanning = true;
    controls.minDistance = 0.3;
    controls.maxDistance = 15;
    controls.addEventListener("change", draw);
    scenes = traces.map((trace) => new ReplayScene(trace, data.colors));
    lookFrom(data.view.eye);
  }

  function above(x, y, z) {
    const [tx, ty, tz] = data.view.target, [ex, ey, ez] = data.view.eye;
    const distance = Math.hypot(ex - tx, ey - ty, ez - tz), norm = Math.hypot(x, y, z);
    return [tx + x / norm * distance, ty + y / norm * distance, tz + z / norm * distance];
  }

  // The chosen view fits a picture of 4 to 3; narrower ones need more distance.
  function lookFrom(eye) {
    if (!camera) return;
    const box = panels[0].view.getBoundingClientRect();
    const aspect = box.height > 0 ? box.width / box.height : 1;
    const [tx, ty, tz] = data.view.target;
    const farther = Math.max(1, 4 / 3 / aspect);
    camera.position.set(tx + farther * (eye[0] - tx), ty + farther * (eye[1] - ty),
                        tz + farther * (eye[2] - tz));
    controls.target.set(tx, ty, tz);
    controls.update();
    draw();
  }

  function resize() {
    chart.draw();
    if (!renderer) return;
    renderer.setSize(stage.clientWidth, stage.clientHeight, false);
    draw();
  }

  function draw() {
    if (isDue) return;
    isDue = true;
    requestAnimationFrame(() => { if (isDue) render(); });
  }

  const speedText = (speed) =>
      Number.isNaN(speed) ? "obstacle's speed not known" : `obstacle ${speed.toFixed(2)} m/s`;

  // Everything as it is at state.t, at once.
  function render() {
    isDue = false;
    clock.textContent = `${state.t.toFixed(2)} s`;
    slider.value = state.t;
    chart.moveTo(state.t);
    for (const {status, words, speed, trace} of panels) {
      const {text, mood} = trace.statusAt(state.t);
      const isOver = state.t > trace.end + 1e-9;
      words.textContent = text;
      speed.textContent = isOver ? "finished"
          : trace.movesObstacles ? speedText(trace.obstacleSpeedAt(state.t)) : "";
      status.dataset.mood = mood;
    }
    tellField();
    if (!renderer) return;
    const outer = canvas.getBoundingClientRect();
    renderer.setScissorTest(false);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.setScissorTest(true);
    panels.forEach(({view}, i) => {
      const box = view.getBoundingClientRect();
      const left = box.left - outer.left, bottom = outer.bottom - box.bottom;
      renderer.setViewport(left, bottom, box.width, box.height);
      renderer.setScissor(left, bottom, box.width, box.height);
      camera.aspect = box.width / Math.max(1, box.height);
      camera.updateProjectionMatrix();
      scenes[i].update(state.t, show);
      renderer.render(scenes[i].scene, camera);
    });
  }

  function tellField() {
    fieldControls.hidden = !show.field || !fields.length;
    if (fieldControls.hidden) return;
    const volume = fields[0].at(state.t, show.ahead);
    fieldNote.textContent = `z = ${fields[0].heightOf(show.layer).toFixed(2)} m` + (volume
        ? `; made at ${volume.seen.toFixed(2)} s, asked about ${volume.t.toFixed(2)} s; lines are 5 cm apart`
        : "; nothing was seen yet");
  }

  // --- Time -------------------------------------------------------------------------------------

  function seek(t) {
    state.t = Math.min(end, Math.max(0, t));
    draw();
  }

  let lastTick = null;
  function tick(now) {
    if (!state.playing) return;
    if (lastTick !== null) state.t += state.speed * Math.min(0.25, (now - lastTick) / 1000);
    lastTick = now;
    if (state.t >= end) {
      state.t = end;
      pause();
    }
    render();
    if (state.playing) requestAnimationFrame(tick);
  }

  function play() {
    if (state.playing) return;
    if (state.t >= end - 1e-6) state.t = 0;
    state.playing = true;
    lastTick = null;
    tellPlaying();
    requestAnimationFrame(tick);
  }

  function pause() {
    state.playing = false;
    tellPlaying();
  }

  function tellPlaying() {
    playButton.textContent = state.playing ? "❚❚" : "▶";
    playButton.setAttribute("aria-label", state.playing ? "Pause" : "Play");
  }

  function toggle(name, on) {
    if (layerBoxes[name].disabled) return;
    show[name] = on === undefined ? !show[name] : on;
    layerBoxes[name].checked = show[name];
    draw();
  }

  function changeSpeed(by) {
    const at = Math.min(SPEEDS.length - 1, Math.max(0, SPEEDS.indexOf(state.speed) + by));
    state.speed = SPEEDS[at];
    speedChoice.value = String(state.speed);
  }

  // --- Light and dark, keys, sizes --------------------------------------------------------------

  const prefersDark = window.matchMedia("(prefers-color-scheme: dark)");
  const page = document.documentElement;
  function themeNow() {
    return state.theme || page.dataset.theme || (prefersDark.matches ? "dark" : "light");
  }
  function setTheme(theme) {
    state.theme = theme;
    if (theme) root.dataset.theme = theme;
    for (const scene of scenes) scene.setTheme(THEMES[themeNow()]);
    draw();
  }
  prefersDark.addEventListener("change", () => setTheme(state.theme));
  new MutationObserver(() => setTheme(state.theme))
      .observe(page, {attributes: true, attributeFilter: ["data-theme"]});

  const keys = {
    " ": () => (state.playing ? pause() : play()),
    ArrowLeft: (event) => { pause(); seek(state.t - (event.shiftKey ? 0.1 : 0.02)); },
    ArrowRight: (event) => { pause(); seek(state.t + (event.shiftKey ? 0.1 : 0.02)); },
    Home: () => { pause(); seek(0); },
    End: () => { pause(); seek(end); },
    "<": () => changeSpeed(-1), ",": () => changeSpeed(-1),
    ">": () => changeSpeed(1), ".": () => changeSpeed(1),
    p: () => toggle("plan"), t: () => toggle("trail"), o: () => toggle("prediction"),
    s: () => toggle("spheres"), f: () => toggle("field"),
    ArrowUp: () => moveLayer(1), ArrowDown: () => moveLayer(-1),
    d: () => setTheme(themeNow() === "dark" ? "light" : "dark"),
    1: () => views.children[0].click(), 2: () => views.children[1].click(),
    3: () => views.children[2].click(), 4: () => views.children[3].click(),
  };
  function moveLayer(by) {
    if (!show.field || !fields.length) return false;
    show.layer = Math.min(fields[0].size[2] - 1, Math.max(0, show.layer + by));
    heightSlider.value = show.layer;
    draw();
    return true;
  }
  const keyTarget = options.keysOf || document;
  keyTarget.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const {tagName, type} = event.target;
    if (tagName === "SELECT" || tagName === "TEXTAREA" || (tagName === "INPUT" && type !== "checkbox")) return;
    if ((tagName === "BUTTON" || tagName === "SUMMARY" || tagName === "INPUT") && event.key === " ") return;
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (act && act(event) !== false) event.preventDefault();
  });

  // What the address asks for: #t=1.2&show=field,spheres&hide=plan&theme=dark&height=0.6
  function obeyAddress() {
    const asked = new URLSearchParams(location.hash.slice(1));
    if (asked.has("theme")) setTheme(asked.get("theme") === "dark" ? "dark" : "light");
    for (const [key, on] of [["show", true], ["hide", false]]) {
      for (const name of (asked.get(key) || "").split(",")) if (layerBoxes[name]) toggle(name, on);
    }
    if (asked.has("height") && fields.length) {
      show.layer = fields[0].layerAt(Number(asked.get("height")));
      heightSlider.value = show.layer;
    }
    if (asked.has("t")) seek(Number(asked.get("t")) || 0);
  }

  setTheme(null);
  tellPlaying();
  if (!options.embedded) {
    obeyAddress();
    window.addEventListener("hashchange", obeyAddress);
  }
  new ResizeObserver(resize).observe(stage);
  resize();
  render();
  return {
    seek, play, pause, toggle, render, canvas,
    state: () => ({t: state.t, playing: state.playing, speed: state.speed, theme: themeNow(), end,
                   show: {...show}, traces: traces.length, webgl: renderer !== null}),
  };
}
