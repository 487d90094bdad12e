"use strict";
// One trace in three dimensions, at any moment.
const ReplayScene = (() => {
  const AHEAD_S = [0.3, 0.6, 0.9, 1.2];      // at which predictions are drawn,
  const OPACITY = [0.34, 0.25, 0.18, 0.12];  // the paler the later
  const FLOOR_M = 24;

  function capsule(radius, half) {
    const points = [], corners = 8;
    for (let i = 0; i <= corners; ++i) {
      const angle = -Math.PI / 2 + Math.PI / 2 * i / corners;
      points.push(new THREE.Vector2(radius * Math.cos(angle), -half + radius * Math.sin(angle)));
    }
    for (let i = 0; i <= corners; ++i) {
      const angle = Math.PI / 2 * i / corners;
      points.push(new THREE.Vector2(radius * Math.cos(angle), half + radius * Math.sin(angle)));
    }
    return new THREE.LatheBufferGeometry(points, 24).rotateX(Math.PI / 2);
  }

  // Sizes as MuJoCo has them: half lengths and radii, the axis along z.
  function geometryOf(shape, size) {
    switch (shape) {
      case "sphere": return new THREE.SphereBufferGeometry(size[0], 28, 18);
      case "ellipsoid": return new THREE.SphereBufferGeometry(1, 28, 18).scale(...size);
      case "capsule": return capsule(size[0], size[1]);
      case "cylinder":
        return new THREE.CylinderBufferGeometry(size[0], size[0], 2 * size[1], 32)
            .rotateX(Math.PI / 2);
      case "box": return new THREE.BoxBufferGeometry(2 * size[0], 2 * size[1], 2 * size[2]);
      default:  // a plane; one without a size is endless
        return new THREE.PlaneBufferGeometry(2 * size[0] || FLOOR_M, 2 * size[1] || FLOOR_M);
    }
  }

  // With flat faces: each triangle has corners of its own.
  function meshGeometry({vertices, triangles}) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
    geometry.setIndex(triangles);
    const flat = geometry.toNonIndexed();
    flat.computeVertexNormals();
    return flat;
  }

  // Squares of half a metre.
  function floorTexture(tones) {
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 128;
    const pen = canvas.getContext("2d");
    for (let i = 0; i < 4; ++i) {
      pen.fillStyle = tones[(i + (i >> 1)) % 2];
      pen.fillRect(64 * (i % 2), 64 * (i >> 1), 64, 64);
    }
    const texture = new THREE.CanvasTexture(canvas);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.anisotropy = 8;
    return texture;
  }

  // A tube along a path, one ring of corners a point, so that any part of it can be shown.
  class PathTube {
    constructor(path, radius, color) {
      const count = path.length / 3, sides = 6;
      const positions = new Float32Array(3 * sides * count);
      const normals = new Float32Array(3 * sides * count);
      const along = new THREE.Vector3(0, 0, 1), step = new THREE.Vector3();
      const side = new THREE.Vector3(), up = new THREE.Vector3(), out = new THREE.Vector3();
      for (let i = 0; i < count; ++i) {
        const a = 3 * Math.max(0, i - 1), b = 3 * Math.min(count - 1, i + 1);
        step.set(path[b] - path[a], path[b + 1] - path[a + 1], path[b + 2] - path[a + 2]);
        if (step.length() > 1e-5) along.copy(step).normalize();
        side.set(Math.abs(along.z) < 0.9 ? 0 : 1, 0, Math.abs(along.z) < 0.9 ? 1 : 0);
        side.cross(along).normalize();
        up.crossVectors(along, side);
        for (let k = 0; k < sides; ++k) {
          const angle = 2 * Math.PI * k / sides, at = 3 * (i * sides + k);
          out.copy(side).multiplyScalar(Math.cos(angle)).addScaledVector(up, Math.sin(angle));
          out.toArray(normals, at);
          for (let c = 0; c < 3; ++c) {
            positions[at + c] = path[3 * i + c] + radius * out.getComponent(c);
          }
        }
      }
      const index = [];
      for (let i = 0; i + 1 < count; ++i) {
        for (let k = 0; k < sides; ++k) {
          const a = i * sides + k, b = i * sides + (k + 1) % sides;
          index.push(a, b, a + sides, b, b + sides, a + sides);
        }
      }
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
      geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
      geometry.setIndex(index);
      this.perPiece = 6 * sides;
      this.pieces = Math.max(0, count - 1);
      this.mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({color}));
      this.mesh.frustumCulled = false;
    }

    show(from, to) {
      const first = Math.min(this.pieces, Math.max(0, from));
      const last = Math.min(this.pieces, Math.max(first, to));
      this.mesh.visible = last > first;
      this.mesh.geometry.setDrawRange(first * this.perPiece, (last - first) * this.perPiece);
    }
  }

  // A box that is expected somewhere: its edges, and a veil over its faces.
  class GhostBox {
    constructor(color, opacity) {
      const box = new THREE.BoxBufferGeometry(2, 2, 2);
      this.group = new THREE.Group();
      this.group.add(new THREE.Mesh(box, new THREE.MeshBasicMaterial(
          {color, transparent: true, opacity: opacity / 2.5, depthWrite: false})));
      this.group.add(new THREE.LineSegments(new THREE.EdgesGeometry(box),
          new THREE.LineBasicMaterial({color, transparent: true, opacity: Math.min(1, 2.4 * opacity)})));
    }
  }

  // A level picture of the field: solids dark, near warm, far pale; a line each tenth of a metre.
  class FieldSlice {
    constructor(field) {
      const [nx, ny] = field.size;
      this.texture = new THREE.DataTexture(new Uint8Array(nx * ny), nx, ny, THREE.LuminanceFormat);
      this.texture.magFilter = this.texture.minFilter = THREE.LinearFilter;
      const material = new THREE.ShaderMaterial({
        uniforms: {distances: {value: this.texture}, reach: {value: field.reach}},
        vertexShader: `varying vec2 place;
          void main() {
            place = uv;
            gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
          }`,
        fragmentShader: `uniform sampler2D distances;
          uniform float reach;
          varying vec2 place;
          void main() {
            float share = texture2D(distances, place).r;
            vec3 color = mix(vec3(0.98, 0.52, 0.2), vec3(0.72, 0.84, 0.98), share);
            float cover = mix(0.82, 0.16, share);
            if (share < 0.004) { color = vec3(0.48, 0.1, 0.12); cover = 0.88; }
            float rings = share * reach / 0.05;
            float width = max(fwidth(rings), 1e-4);
            float line = 1.0 - smoothstep(0.6, 1.5, abs(fract(rings + 0.5) - 0.5) / width);
            if (share > 0.01 && share < 0.99) {
              color = mix(color, vec3(0.15, 0.13, 0.2), 0.55 * line);
              cover = max(cover, 0.6 * line);
            }
            gl_FragColor = vec4(color, cover);
          }`,
        transparent: true, depthWrite: false, side: THREE.DoubleSide,
        extensions: {derivatives: true},
      });
      const plane = new THREE.PlaneBufferGeometry(nx * field.cell, ny * field.cell);
      this.mesh = new THREE.Mesh(plane, material);
      this.mesh.position.set(field.first[0] + field.cell * (nx - 1) / 2,
                             field.first[1] + field.cell * (ny - 1) / 2, 0);
      this.mesh.renderOrder = 2;
    }

    show(values, height) {
      this.mesh.position.z = height;
      this.texture.image.data.set(values);
      this.texture.needsUpdate = true;
    }
  }

  return class {
    constructor(trace, colors) {
      this.trace = trace;
      this.colors = colors;
      this.scene = new THREE.Scene();
      this.light();
      this.addGeoms();
      this.addSpheres();
      this.trail = new PathTube(trace.trail.path, 0.008, colors.trail);
      this.scene.add(this.trail.mesh);
      this.plans = new Map();
      this.ghosts = [];
      this.touch = new THREE.Mesh(new THREE.SphereBufferGeometry(0.045, 20, 14),
          new THREE.MeshBasicMaterial({color: colors.contact, transparent: true, opacity: 0.85,
                                       depthTest: false}));
      this.touch.renderOrder = 3;
      this.scene.add(this.touch);
      if (trace.field.cycles > 0) {
        this.slice = new FieldSlice(trace.field);
        this.scene.add(this.slice.mesh);
      }
    }

    light() {
      this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8890a0, 0.72));
      const sun = new THREE.DirectionalLight(0xffffff, 0.62);
      sun.position.set(-1.6, -2.4, 5);
      sun.target.position.set(0.4, 0, 0.4);
      sun.castShadow = true;
      sun.shadow.mapSize.set(2048, 2048);
      sun.shadow.bias = -0.0004;
      Object.assign(sun.shadow.camera, {left: -3, right: 3, top: 3, bottom: -3, near: 0.5, far: 12});
      this.scene.add(sun, sun.target);
    }

    addGeoms() {
      this.bodies = [];
      for (let i = 0; i < this.trace.frames.bodies; ++i) {
        this.bodies.push(new THREE.Group());
        this.scene.add(this.bodies[i]);
      }
      for (const geom of this.trace.geoms) {
        const geometry = geom.shape === "mesh" ? meshGeometry(this.trace.meshes[geom.mesh])
                                               : geometryOf(geom.shape, geom.size);
        const mesh = geom.role === "contact_box" ? this.glass(geometry) : this.solid(geom, geometry);
        const [x, y, z, qx, qy, qz, qw] = geom.pose;
        mesh.position.set(x, y, z);
        mesh.quaternion.set(qx, qy, qz, qw);
        (geom.body < 0 ? this.scene : this.bodies[geom.body]).add(mesh);
      }
    }

    solid(geom, geometry) {
      const [r, g, b, a] = geom.rgba;
      const material = new THREE.MeshPhongMaterial({
        color: new THREE.Color(r, g, b), specular: 0x222222, shininess: 30,
        transparent: a < 1, opacity: a,
      });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.castShadow = geom.shape !== "plane";
      mesh.receiveShadow = true;
      if (geom.shape === "plane") (this.floors = this.floors || []).push(mesh);
      return mesh;
    }

    glass(geometry) {
      const group = new THREE.Group();
      group.add(new THREE.Mesh(geometry, new THREE.MeshBasicMaterial(
          {color: 0x70849c, transparent: true, opacity: 0.08, depthWrite: false})));
      group.add(new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 30),
          new THREE.LineBasicMaterial({color: 0x70849c, transparent: true, opacity: 0.6})));
      return group;
    }

    addSpheres() {
      this.spheres = new THREE.Group();
      const material = new THREE.MeshPhongMaterial(
          {color: 0x19a7b8, transparent: true, opacity: 0.3, depthWrite: false});
      for (const radius of this.trace.spheres.radii) {
        this.spheres.add(new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 18, 12), material));
      }
      this.spheres.renderOrder = 1;
      this.scene.add(this.spheres);
    }

    setTheme(theme) {
      this.scene.background = new THREE.Color(theme.sky);
      this.scene.fog = new THREE.Fog(theme.sky, 7, 13);
      for (const floor of this.floors || []) {
        const texture = floorTexture(theme.floor);
        texture.repeat.set(floor.geometry.parameters.width, floor.geometry.parameters.height);
        floor.material.map = texture;
        floor.material.color.set(0xffffff);
        floor.material.needsUpdate = true;
      }
    }

    // Puts everything where it is at t. `show` says which things are drawn.
    update(t, show) {
      const now = Math.min(t, this.trace.end);
      this.moveBodies(now);
      this.moveSpheres(now, show.spheres);
      this.trail.show(0, show.trail ? Math.floor(now / this.trace.trail.step) : 0);
      this.showPlan(now, show.plan);
      this.showPredictions(now, show.prediction);
      this.showField(now, show);
      const touch = this.trace.touchAt(now);
      this.touch.visible = touch !== null;
      if (touch) this.touch.position.set(...touch);
    }

    moveBodies(t) {
      const {bodies, poses} = this.trace.frames;
      const {before, after, share} = this.trace.frameAt(t);
      this.bodies.forEach((body, i) => ReplayData.poseBetween(
          poses, before * bodies + i, after * bodies + i, share, body.position, body.quaternion));
    }

    moveSpheres(t, shown) {
      this.spheres.visible = shown;
      if (!shown) return;
      const {centres, radii} = this.trace.spheres;
      const {before, after, share} = this.trace.frameAt(t);
      this.spheres.children.forEach((sphere, i) => {
        const a = 3 * (before * radii.length + i), b = 3 * (after * radii.length + i);
        sphere.position.set(centres[a] + share * (centres[b] - centres[a]),
                            centres[a + 1] + share * (centres[b + 1] - centres[a + 1]),
                            centres[a + 2] + share * (centres[b + 2] - centres[a + 2]));
      });
    }

    showPlan(t, shown) {
      const plan = this.trace.planAt(t);
      for (const [other, tube] of this.plans) tube.mesh.visible = shown && other === plan;
      if (!plan || !shown) return;
      if (!this.plans.has(plan)) {
        const tube = new PathTube(plan.path, 0.009, this.colors.plan);
        this.plans.set(plan, tube);
        this.scene.add(tube.mesh);
      }
      const tube = this.plans.get(plan);
      tube.show(Math.floor((t - plan.effect) / plan.step), tube.pieces);
    }

    showPredictions(t, shown) {
      const objects = shown ? this.trace.predictionsAt(t) : [];
      let used = 0;
      for (const object of objects) {
        AHEAD_S.forEach((ahead, i) => {
          if (used === this.ghosts.length) {
            this.ghosts.push(new GhostBox(this.colors.prediction, OPACITY[i]));
            this.scene.add(this.ghosts[used].group);
          }
          const group = this.ghosts[used++].group;
          const {before, after, share} = ReplayData.locate(object.t, t + ahead);
          ReplayData.poseBetween(object.poses, before, after, share, group.position, group.quaternion);
          group.scale.set(...object.half.map((half) => Math.max(half, 1e-3)));
          group.visible = true;
        });
      }
      for (let i = used; i < this.ghosts.length; ++i) this.ghosts[i].group.visible = false;
    }

    showField(t, show) {
      if (!this.slice) return;
      const field = this.trace.field;
      const volume = show.field ? field.at(t, show.ahead) : null;
      this.slice.mesh.visible = volume !== null;
      if (volume) this.slice.show(field.layer(volume, show.layer), field.heightOf(show.layer));
    }
  };
})();
