"use strict";
// What a replay's data says: arrays from its texts, and answers about one moment.
const ReplayData = (() => {
  function bytes(text) {
    const raw = atob(text);
    const values = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) values[i] = raw.charCodeAt(i);
    return values;
  }

  function floats(text) {
    return new Float32Array(bytes(text).buffer);
  }

  // Puts changes in place, as PackChanges tells them.
  function applyChanges(changes, values) {
    let at = 0, to = 0;
    const count = () => {
      let number = 0, shift = 0, byte;
      do {
        byte = changes[at++];
        number += (byte & 127) << shift;
        shift += 7;
      } while (byte > 127);
      return number;
    };
    while (at < changes.length) {
      to += count();
      const end = to + count();
      while (to < end) values[to++] = changes[at++];
    }
  }

  // The last place whose time is not after t; -1 before the first one.
  function lastUntil(count, timeOf, t) {
    let low = 0, high = count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (timeOf(middle) <= t + 1e-9) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  // Poses (x, y, z and a quaternion x, y, z, w) between two of a list, into the given three.js
  // values.
  const second = typeof THREE === "undefined" ? null : new THREE.Quaternion();
  function poseBetween(poses, from, to, share, position, quaternion) {
    const a = 7 * from, b = 7 * to;
    position.set(poses[a] + share * (poses[b] - poses[a]),
                 poses[a + 1] + share * (poses[b + 1] - poses[a + 1]),
                 poses[a + 2] + share * (poses[b + 2] - poses[a + 2]));
    quaternion.set(poses[a + 3], poses[a + 4], poses[a + 5], poses[a + 6]);
    second.set(poses[b + 3], poses[b + 4], poses[b + 5], poses[b + 6]);
    quaternion.slerp(second, share);
  }

  // Where t falls among times.
  function locate(times, t) {
    const before = Math.max(0, lastUntil(times.length, (i) => times[i], t));
    const after = Math.min(before + 1, times.length - 1);
    const span = times[after] - times[before];
    const share = span > 0 ? Math.min(1, Math.max(0, (t - times[before]) / span)) : 0;
    return {before, after, share};
  }

  // The distances that planning believed in, cycle after cycle.
  class Field {
    constructor(data) {
      this.whyNone = data.why_none;
      this.size = data.size || [0, 0, 0];
      this.first = data.first;
      this.cell = data.cell;
      this.reach = data.reach;
      this.ahead = data.ahead || [];
      this.packed = data.volumes;
      this.cycles = this.ahead.length ? data.volumes.length / this.ahead.length : 0;
    }

    // Unpacked when somebody wants to see them.
    get volumes() {
      if (!this.unpacked) {
        const count = this.size[0] * this.size[1] * this.size[2];
        const latest = this.ahead.map(() => new Uint8Array(count).fill(255));
        this.unpacked = this.packed.map((volume, i) => {
          const distance = latest[i % this.ahead.length].slice();
          applyChanges(bytes(volume.changes), distance);
          latest[i % this.ahead.length] = distance;
          return {seen: volume.seen_s, t: volume.t, distance};
        });
      }
      return this.unpacked;
    }

    // The volume made last before t, about so much later (a place in `ahead`); null before any.
    at(t, ahead) {
      const stride = this.ahead.length;
      const cycle = lastUntil(this.cycles, (i) => this.packed[i * stride].seen_s, t);
      return cycle < 0 ? null : this.volumes[cycle * stride + ahead];
    }

    heightOf(layer) { return this.first[2] + this.cell * layer; }
    layerAt(height) {
      return Math.min(this.size[2] - 1, Math.max(0, Math.round((height - this.first[2]) / this.cell)));
    }
    layer(volume, k) {
      const area = this.size[0] * this.size[1];
      return volume.distance.subarray(area * k, area * (k + 1));
    }
  }

  class Trace {
    constructor(data) {
      this.name = data.name;
      this.title = data.title;
      this.explanation = data.explanation;
      this.place = data.place;
      this.facts = data.facts;
      this.end = data.end_s;
      this.geoms = data.geoms;
      this.meshes = data.meshes.map(
          ({vertices, triangles}) => ({vertices: floats(vertices), triangles}));
      this.frames = {
        step: data.frames.step_s, count: data.frames.count, bodies: data.frames.bodies,
        poses: floats(data.frames.poses), obstacleSpeed: floats(data.frames.obstacle_speed),
      };
      this.spheres = {
        radii: data.spheres.radii, centres: floats(data.spheres.centres),
        whyNone: data.spheres.why_none,
      };
      const motion = data.motion;
      this.trail = {step: motion.trail.step_s, path: floats(motion.trail.path)};
      this.plans = motion.plans.map(
          (plan) => ({effect: plan.effect_s, step: plan.step_s, path: floats(plan.path)}));
      this.predictions = motion.predictions.map((object) => ({
        effect: object.effect_s, half: object.half, t: floats(object.t), poses: floats(object.poses),
      }));
      this.statuses = data.timeline.statuses;
      this.marks = data.timeline.marks;
      this.touches = data.timeline.touches;
      this.clearance = {t: floats(data.timeline.clearance.t), d: floats(data.timeline.clearance.d)};
      this.margin = data.timeline.margin_m;
      this.field = new Field(data.field);
    }

    // The frames around t.
    frameAt(t) {
      const at = Math.min(Math.max(t, 0), this.end) / (this.frames.step || 1);
      const before = Math.min(Math.floor(at), this.frames.count - 1);
      return {before, after: Math.min(before + 1, this.frames.count - 1), share: at - before};
    }

    get movesObstacles() {
      return this.geoms.some((geom) => geom.body >= 0 && geom.role === "obstacle");
    }

    obstacleSpeedAt(t) { return this.frames.obstacleSpeed[this.frameAt(t).before]; }

    planAt(t) {
      const i = lastUntil(this.plans.length, (k) => this.plans[k].effect, t);
      return i < 0 ? null : this.plans[i];
    }

    predictionsAt(t) {
      const plan = this.planAt(t);
      return plan ? this.predictions.filter((object) => object.effect === plan.effect) : [];
    }

    statusAt(t) {
      const i = lastUntil(this.statuses.length, (k) => this.statuses[k][0], Math.min(t, this.end));
      return i < 0 ? {text: "", mood: "neutral"}
                   : {text: this.statuses[i][1], mood: this.statuses[i][2]};
    }

    clearanceAt(t) {
      const i = lastUntil(this.clearance.t.length, (k) => this.clearance.t[k], t);
      return i < 0 ? null : this.clearance.d[i];
    }

    // A touch of the last quarter of a second.
    touchAt(t) {
      const i = lastUntil(this.touches.length, (k) => this.touches[k][0], t);
      return i >= 0 && t - this.touches[i][0] < 0.25 ? this.touches[i][1] : null;
    }
  }

  return {Trace, Field, locate, lastUntil, poseBetween, applyChanges, floats};
})();
