'use strict';

// The arm in the page: the picture of a figure, to be turned. The data of a scene stand beside the figure as JSON (lengths in
// mm, vectors in µm, axes of the base frame); shapes, colours, views and keys are those of the program's pictures and of
// stiffscope-view. Where there is no WebGL, no script, or on paper, the picture stands instead.
(function () {
  const scenes = Array.from(document.querySelectorAll('script.scene'));
  const packed = document.getElementById('three');
  if (scenes.length === 0 || !packed || !window.DecompressionStream) return;

  const opened = performance.now();

  // ---- three.js, unpacked once for all scenes

  let three = null;
  function loadThree() {
    if (three) return three;
    const bytes = Uint8Array.from(atob(packed.textContent), (letter) => letter.charCodeAt(0));
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
    three = new Response(plain).text().then((code) => {
      const script = document.createElement('script');
      script.textContent = code;
      document.head.appendChild(script);
      return window.THREE;
    });
    return three;
  }

  // ---- vectors as arrays

  const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
  const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
  const times = (a, f) => [a[0] * f, a[1] * f, a[2] * f];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const norm = (a) => Math.hypot(a[0], a[1], a[2]);
  const unit = (a) => times(a, 1 / (norm(a) || 1));
  const mix = (colour, ground, share) => colour.map((channel, i) => ground[i] + share * (channel - ground[i]));
  const css = (colour) => 'rgb(' + colour.map(Math.round).join(',') + ')';

  // The largest of 1, 2, 5, 10, ... not above x.
  function roundDown125(x) {
    const power = Math.pow(10, Math.floor(Math.log10(x) + 1e-9));
    const lead = x / power;
    return (lead >= 5 - 1e-9 ? 5 : lead >= 2 - 1e-9 ? 2 : 1) * power;
  }

  const shortNumber = (x) => String(Number(x.toPrecision(4)));

  // ---- the arm's shape, as render/vtk/arm_shape makes it

  // Solids of revolution in one surface; the light is part of the colours of its corners.
  class Mesh {
    constructor(light, ambient, sides) {
      this.light = light;
      this.ambient = ambient;
      this.sides = sides;
      this.points = [];
      this.colours = [];
      this.triangles = [];
    }
    corner(point, normal, colour) {
      const light = this.ambient + (1.06 - this.ambient) * Math.max(0, dot(normal, this.light));
      this.points.push(point[0], point[1], point[2]);
      for (const channel of colour) this.colours.push(Math.min(1, (channel / 255) * light));
      return this.points.length / 3 - 1;
    }
    cone(from, fromRadius, to, toRadius, colour) {
      const length = norm(sub(to, from));
      if (!(length > 1e-6)) return;
      const axis = times(sub(to, from), 1 / length);
      const u = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
      const v = cross(axis, u);
      const slope = (fromRadius - toRadius) / length;
      const fromCentre = this.corner(from, times(axis, -1), colour);
      const toCentre = this.corner(to, axis, colour);
      const first = toCentre + 1;
      for (let i = 0; i < this.sides; ++i) {
        const angle = (2 * Math.PI * i) / this.sides;
        const radial = add(times(u, Math.cos(angle)), times(v, Math.sin(angle)));
        const normal = unit(add(radial, times(axis, slope)));
        const low = add(from, times(radial, fromRadius));
        const high = add(to, times(radial, toRadius));
        this.corner(low, normal, colour);
        this.corner(high, normal, colour);
        this.corner(low, times(axis, -1), colour);
        this.corner(high, axis, colour);
      }
      for (let i = 0; i < this.sides; ++i) {
        const a = first + 4 * i;
        const b = first + 4 * ((i + 1) % this.sides);
        this.triangles.push(a, b, b + 1, a, b + 1, a + 1, fromCentre, b + 2, a + 2, toCentre, a + 3, b + 3);
      }
    }
    sphere(centre, radius, colour, sides = this.sides) {
      const rings = sides / 2;
      const first = this.points.length / 3;
      for (let ring = 0; ring <= rings; ++ring) {
        const latitude = (Math.PI * ring) / rings;
        for (let i = 0; i < sides; ++i) {
          const angle = (2 * Math.PI * i) / sides;
          const normal = [Math.sin(latitude) * Math.cos(angle), Math.sin(latitude) * Math.sin(angle), Math.cos(latitude)];
          this.corner(add(centre, times(normal, radius)), normal, colour);
        }
      }
      for (let ring = 0; ring < rings; ++ring) {
        for (let i = 0; i < sides; ++i) {
          const a = first + sides * ring + i;
          const b = first + sides * ring + ((i + 1) % sides);
          this.triangles.push(a, a + sides, b + sides, a, b + sides, b);
        }
      }
    }
    arrow(from, to, radius, headLength, colour) {
      const length = norm(sub(to, from));
      if (!(length > 1e-6)) return;
      const head = Math.min(headLength, 0.6 * length);
      const neck = sub(to, times(sub(to, from), head / length));
      this.cone(from, radius, neck, radius, colour);
      this.cone(neck, Math.max(0.4 * head, 1.4 * radius), to, 0, colour);
    }
    object(THREE, material) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(this.points, 3));
      geometry.setAttribute('color', new THREE.Float32BufferAttribute(this.colours, 3));
      geometry.setIndex(this.triangles);
      return new THREE.Mesh(geometry, material);
    }
  }

  function proportions(frame) {
    let length = 0;
    for (let i = 1; i < frame.joints.length; ++i) length += norm(sub(frame.joints[i], frame.joints[i - 1]));
    const base = 0.042 * length;
    const tip = 0.018 * length;
    return { base, tip, target: 0.6 * tip, at: (along) => base + (tip - base) * (length > 0 ? along / length : 0) };
  }

  // Where the arrow of a load ends, whatever the force: newtons have no scale beside magnified millimetres.
  function loadTip(frame) {
    if (!frame.load_at || !(norm(frame.force) > 0)) return null;
    let length = 0;
    for (let i = 1; i < frame.joints.length; ++i) length += norm(sub(frame.joints[i], frame.joints[i - 1]));
    return add(frame.load_at, times(unit(frame.force), 0.15 * length));
  }

  function addArm(mesh, frame, palette) {
    const size = proportions(frame);
    const joints = frame.joints;
    // The pedestal.
    const foot = [joints[0][0], joints[0][1], Math.min(0, joints[0][2])];
    const plate = add(foot, [0, 0, 0.35 * size.base]);
    mesh.cone(foot, 2.1 * size.base, plate, 2.1 * size.base, palette.joint);
    if (joints[0][2] > plate[2]) mesh.cone(plate, 1.7 * size.base, joints[0], 1.5 * size.base, palette.joint);
    let along = 0;
    for (let i = 0; i + 1 < joints.length; ++i) {
      const radius = size.at(along);
      along += norm(sub(joints[i + 1], joints[i]));
      const next = size.at(along);
      const axis = unit(frame.axes[i]);
      if (i === 0) {
        // The waist: up the first axis as far as the shoulder, then across to it.
        const corner = add(joints[0], times(axis, dot(axis, sub(joints[1], joints[0]))));
        const drum = add(joints[0], times(axis, Math.min(250, 0.6 * radius)));
        mesh.cone(joints[0], 1.45 * radius, drum, 1.45 * radius, palette.joint);
        mesh.cone(joints[0], 1.2 * radius, corner, 1.05 * radius, palette.link);
        mesh.sphere(corner, 1.05 * radius, palette.link);
        mesh.cone(corner, 1.05 * radius, joints[1], next, palette.link);
        continue;
      }
      const half = times(axis, 1.35 * radius);
      mesh.cone(sub(joints[i], half), 1.28 * radius, add(joints[i], half), 1.28 * radius, palette.joint);
      mesh.cone(joints[i], radius, joints[i + 1], next, palette.link);
    }
    // The flange faces away from the arm; the reflectors' holders start at it.
    const flange = joints[joints.length - 1];
    const axis = unit(frame.axes[frame.axes.length - 1]);
    const side = dot(axis, sub(flange, joints[joints.length - 2])) < 0 ? -1 : 1;
    mesh.cone(sub(flange, times(axis, 0.6 * side * size.tip)), 1.7 * size.tip, flange, 1.7 * size.tip, palette.joint);
    for (const point of frame.points) {
      if (point.wrist) continue;
      mesh.cone(flange, 0.25 * size.tip, point.at, 0.25 * size.tip, palette.joint);
      mesh.sphere(point.at, size.target, palette.target);
    }
  }

  // ---- views

  const VIEWS = { 1: [-1, 0, 0], 2: [0, 1, 0], 3: [0, 0, -1], 4: unit([-0.5, 0.85, -0.42]) };  // front, side, top, oblique
  const STEEPEST = 1.52;  // rad

  function axesOf(direction) {
    const upwards = Math.abs(direction[2]) > 0.999 ? [0, 1, 0] : [0, 0, 1];
    const right = unit(cross(direction, upwards));
    return { right, up: cross(right, direction), toViewer: times(direction, -1) };
  }

  function turned(direction, aboutVertical, towards) {
    const level = Math.hypot(direction[0], direction[1]);
    let heading = level > 1e-9 ? Math.atan2(direction[1], direction[0]) : Math.PI / 2;
    let dip = Math.atan2(-direction[2], level);
    heading -= aboutVertical;
    dip = Math.max(-STEEPEST, Math.min(STEEPEST, dip + towards));
    return [Math.cos(dip) * Math.cos(heading), Math.cos(dip) * Math.sin(heading), -Math.sin(dip)];
  }

  const KEYS = [
    ['← →', 'posture'], ['↑ ↓', 'load step'], ['m', 'measured on/off'], ['p', 'predicted on/off'], ['r', 'residual on/off'],
    ['e', 'effects on/off'], ['c', 'colour by share of the effects'], ['+ −', 'longer, shorter vectors'],
    ['a', 'length to suit'], ['. ,', 'longer, shorter residuals'], ['n', 'next method'], ['Tab', "next point's numbers"],
    ['1 2 3 4', 'front, side, top, oblique'], ['Shift+arrow', 'turn'], ['i o', 'nearer, farther'],
    ['b', 'light, dark background'], ['s', 'save the picture (PNG)'], ['0', 'reset'], ['h ?', 'this list'],
    ['q', 'back to the picture'], ['drag', 'turn'], ['right drag', 'shift'], ['wheel', 'zoom'], ['click', "a point's numbers"]];

  const hasWebGl = () => {
    const canvas = document.createElement('canvas');
    return Boolean(canvas.getContext('webgl') || canvas.getContext('webgl2'));
  };

  const element = (name, attributes = {}, text = '') => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };

  // Text with x_{abc} as a subscript.
  function rich(into, text) {
    into.textContent = '';
    text.split(/_\{([^}]*)\}/).forEach((part, i) => {
      if (part) into.appendChild(i % 2 ? element('sub', {}, part) : document.createTextNode(part));
    });
    return into;
  }
  const plain = (text) => text.replace(/_\{([^}]*)\}/g, '$1');

  class Scene {
    constructor(THREE, figure, data) {
      this.THREE = THREE;
      this.figure = figure;
      this.data = data;
      this.at = data.first;
      this.method = 0;
      this.picked = '';
      this.shown = {};
      for (const vector of data.vectors) this.shown[vector.key] = vector.key !== 'e';
      this.byShare = false;
      this.magnification = data.magnification;
      this.residualFactor = data.residual_factor;
      this.dark = matchMedia('(prefers-color-scheme: dark)').matches;
      this.home = data.view ? unit(data.view) : VIEWS[4];
      this.direction = this.home;
      this.held = null;
      this.build();
      this.bind();
      this.draw();
    }

    get frame() { return this.data.frames[this.at]; }
    get palette() { return this.dark ? this.data.palette.dark : this.data.palette.light; }

    // ---- what is drawn

    // The vectors of a point: those of the data, the prediction of the method, and the residual between, µm.
    vectorsOf(point) {
      const method = this.data.methods[this.method];
      const predicted = point.p && method ? point.p[method.key] : undefined;
      const residual = point.r || (predicted && point.m ? sub(point.m, predicted) : undefined);
      return { m: point.m, p: predicted, r: residual, e: point.e };
    }

    factorOf(key) { return 1e-3 * this.magnification * (key === 'r' ? this.residualFactor : 1); }

    // The share of the effects in what was measured, 0 to 1.
    shareOf(vectors) {
      if (!vectors.e || !vectors.m) return 0;
      const whole = norm(add(vectors.m, this.data.corrected ? vectors.e : [0, 0, 0]));
      return whole > 0 ? Math.min(1, norm(vectors.e) / whole) : 0;
    }

    build() {
      const { THREE } = this;
      this.room = element('div', { class: 'room' });
      this.canvas = element('canvas', { tabindex: '0', role: 'img',
        'aria-label': 'The arm, to be turned: arrow keys step through postures and loads, h lists all keys' });
      this.labels = element('canvas', { class: 'labels', 'aria-hidden': 'true' });
      this.numbers = element('div', { class: 'numbers-of-point', 'aria-live': 'polite' });
      this.keys = element('table', { class: 'keys' });
      this.keys.hidden = true;
      for (const [key, does] of KEYS) {
        const row = this.keys.insertRow();
        row.appendChild(element('th', { scope: 'row' }, key));
        row.appendChild(element('td', {}, does));
      }
      this.bar = element('div', { class: 'bar' });
      this.status = element('div', { class: 'status' });
      const context = { canvas: this.canvas, antialias: true, preserveDrawingBuffer: true };
      if (!hasWebGl()) throw new Error('no WebGL');  // asked first: three.js would complain on the console
      this.renderer = new THREE.WebGLRenderer(context);
      this.renderer.autoClear = false;
      this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 1, 100);
      this.camera.matrixAutoUpdate = false;
      // Kept: a material that goes takes its compiled shaders along, and the next frame would compile them again.
      this.surface = new THREE.MeshBasicMaterial({ vertexColors: THREE.VertexColors });
      this.line = new THREE.LineBasicMaterial();
      this.room.append(this.canvas, this.labels, this.numbers, this.keys);
      this.live = element('div', { class: 'scene-live' });
      this.live.append(this.bar, this.room, this.status);
      this.fillBar();
      this.figure.querySelector('.picture').after(this.live);
      this.figure.classList.add('live');
    }

    button(text, title, act) {
      const made = element('button', { type: 'button', title }, text);
      made.addEventListener('click', act);
      this.bar.appendChild(made);
      return made;
    }

    choice(title, options, chosen, act) {
      const select = element('select', { title, 'aria-label': title });
      for (const [value, text] of options) select.appendChild(element('option', { value }, text));
      select.value = chosen;
      select.addEventListener('change', () => act(select.value));
      this.bar.appendChild(select);
      return select;
    }

    fillBar() {
      const { data } = this;
      const postures = [], steps = [];
      for (const frame of data.frames) {
        if (!postures.some(([value]) => value === frame.id)) postures.push([frame.id, frame.where]);
        if (frame.load && !steps.some(([value]) => value === String(frame.step))) steps.push([String(frame.step), 'load step ' + frame.step]);
      }
      this.button('‹', 'posture before (←)', () => this.stepPosture(-1));
      this.postures = this.choice('posture', postures, this.frame.id, (id) => this.showPosture(id, true));
      this.button('›', 'next posture (→)', () => this.stepPosture(1));
      if (steps.length > 1) this.steps = this.choice('load step', steps, String(this.frame.step), (step) => this.showStep(Number(step)));
      if (data.methods.length > 1)
        this.methods = this.choice('method of the prediction', data.methods.map((m, i) => [String(i), m.name]), '0',
          (i) => { this.method = Number(i); this.draw(); });
      this.boxes = {};
      for (const vector of data.vectors) {
        const label = element('label');
        const box = element('input', { type: 'checkbox' });
        box.checked = this.shown[vector.key];
        box.addEventListener('change', () => { this.shown[vector.key] = box.checked; this.draw(); });
        const patch = element('i');
        label.append(box, patch, document.createTextNode(vector.name));
        this.bar.appendChild(label);
        this.boxes[vector.key] = { box, patch };
      }
      if (data.vectors.some((vector) => vector.key === 'e')) {
        const label = element('label', { title: 'share of the effects in the displacement (c)' });
        this.shareBox = element('input', { type: 'checkbox' });
        this.shareBox.addEventListener('change', () => { this.byShare = this.shareBox.checked; this.draw(); });
        label.append(this.shareBox, document.createTextNode('by share'));
        this.bar.appendChild(label);
      }
      if (data.vectors.length > 0) {
        this.button('−', 'shorter vectors (−)', () => this.lengthen(0.5));
        this.button('+', 'longer vectors (+)', () => this.lengthen(2));
      }
      this.button('reset', 'reset (0)', () => this.reset());
      this.button('keys', 'keys (h)', () => this.toggleKeys());
      this.button('picture', 'back to the picture (q)', () => this.close());
    }

    // The box around all postures of this step, so that stepping does not move the view. A vector counts with half of what
    // its arm reaches at most: one bad reading, magnified a thousand times, would make the arm a dot.
    extent(axes) {
      const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
      const include = (point, around) => {
        const view = [dot(axes.right, point), dot(axes.up, point), dot(axes.toViewer, point)];
        for (let i = 0; i < 3; ++i) {
          low[i] = Math.min(low[i], view[i] - around);
          high[i] = Math.max(high[i], view[i] + around);
        }
      };
      for (const frame of this.data.frames) {
        if (frame.step !== this.frame.step) continue;
        const size = proportions(frame);
        const reach = Math.max(...frame.joints.map((joint) => norm(sub(joint, frame.joints[0]))));
        for (const joint of frame.joints) include(joint, 1.8 * size.base);
        include([frame.joints[0][0], frame.joints[0][1], 0], 2.2 * size.base);
        if (loadTip(frame)) include(loadTip(frame), size.tip);
        for (const point of frame.points) {
          include(point.at, size.tip);
          const vectors = this.vectorsOf(point);
          for (const key of Object.keys(vectors)) {
            if (!vectors[key] || !this.shown[key]) continue;
            const drawn = times(vectors[key], this.factorOf(key));
            include(add(point.at, times(drawn, Math.min(1, (0.5 * reach) / (norm(drawn) || 1)))), size.tip);
          }
        }
      }
      for (const trace of this.data.traces || []) for (const point of trace.points) include(point, 0);
      return { low, high };
    }

    // What the camera shows: the centre of the room (mm) and how many mm its height is.
    framing() {
      const axes = axesOf(this.direction);
      if (this.held) return { axes, ...this.held };
      const { low, high } = this.extent(axes);
      const middle = low.map((value, i) => (value + high[i]) / 2);
      const centre = add(add(times(axes.right, middle[0]), times(axes.up, middle[1])), times(axes.toViewer, middle[2]));
      const aspect = this.width / this.height;
      const high_mm = 1.12 * Math.max(high[1] - low[1], (high[0] - low[0]) / aspect);
      return { axes, centre, high_mm };
    }

    spotOf(point) {
      const { axes, centre, high_mm } = this.view;
      const off = sub(point, centre);
      const scale = this.height / high_mm;
      return [this.width / 2 + scale * dot(axes.right, off), this.height / 2 - scale * dot(axes.up, off)];
    }

    resize() {
      const width = Math.max(280, this.fixedWidth || this.room.clientWidth);
      const height = Math.round((this.fixedHeight || (width * 2) / 3));
      const ratio = this.fixedWidth ? 1 : Math.min(2, window.devicePixelRatio || 1);
      if (width === this.width && height === this.height) return;
      this.width = width;
      this.height = height;
      this.renderer.setPixelRatio(ratio);
      this.renderer.setSize(width, height);
      this.labels.width = width * ratio;
      this.labels.height = height * ratio;
      this.labels.style.width = width + 'px';
      this.labels.style.height = height + 'px';
      this.ratio = ratio;
    }

    // One layer: what it holds is never hidden by the layers before it.
    layer(object) {
      const { THREE } = this;
      const scene = new THREE.Scene();
      scene.add(object);
      this.renderer.clearDepth();
      this.renderer.render(scene, this.camera);
      object.geometry.dispose();
    }

    draw() {
      if (this.closed) return;
      this.resize();
      this.view = this.framing();
      const { THREE, view, palette } = this;
      const depth = 20000;  // mm, more than an arm reaches
      const wide_mm = (view.high_mm * this.width) / this.height;
      Object.assign(this.camera, { left: -wide_mm / 2, right: wide_mm / 2, top: view.high_mm / 2, bottom: -view.high_mm / 2,
        near: 1, far: 2 * depth });
      this.camera.updateProjectionMatrix();
      const basis = new THREE.Matrix4().makeBasis(...[view.axes.right, view.axes.up, view.axes.toViewer].map((a) => new THREE.Vector3(...a)));
      basis.setPosition(new THREE.Vector3(...add(view.centre, times(view.axes.toViewer, depth))));
      this.camera.matrix.copy(basis);
      this.camera.updateMatrixWorld(true);
      this.renderer.setClearColor(new THREE.Color(...palette.paper.map((c) => c / 255)), 1);
      this.renderer.clear();
      const light = unit(add(add(times(view.axes.right, -0.45), times(view.axes.up, 0.65)), times(view.axes.toViewer, 0.7)));
      this.layer(this.floor());
      const arm = new Mesh(light, 0.55, 40);
      addArm(arm, this.frame, palette);
      this.layer(arm.object(THREE, this.surface));
      const mm = view.high_mm / this.height;  // a pixel
      for (const vector of this.data.vectors) {
        if (!this.shown[vector.key]) continue;
        const mesh = new Mesh(light, 0.86, 16);
        for (const point of this.frame.points) {
          const vectors = this.vectorsOf(point);
          if (!vectors[vector.key]) continue;
          const colour = this.byShare ? this.shareColour(this.shareOf(vectors)) : palette[vector.colour];
          mesh.arrow(point.at, add(point.at, times(vectors[vector.key], this.factorOf(vector.key))), (vector.width / 2) * mm, (vector.head || 15) * mm, colour);
        }
        if (mesh.triangles.length > 0) this.layer(mesh.object(THREE, this.surface));
      }
      const dots = new Mesh(light, 0.86, 16);
      for (const point of this.frame.points) if (point.wrist) dots.sphere(point.at, 6 * mm, palette.wrist);
      for (const trace of this.data.traces || []) {
        const now = trace.axis === this.frame.posture;
        for (const point of trace.points) dots.sphere(point, (now ? 4 : 3) * mm, mix(palette.measured, palette.paper, now ? 1 : 0.35), 8);
      }
      if (dots.triangles.length > 0) this.layer(dots.object(THREE, this.surface));
      this.drawLabels();
      this.tell();
      this.drawn = (this.drawn || 0) + 1;
    }

    floor() {
      const { THREE, palette } = this;
      const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
      for (const frame of this.data.frames) {
        for (const point of frame.joints.concat(frame.points.map((p) => p.at))) {
          for (let i = 0; i < 2; ++i) {
            low[i] = Math.min(low[i], point[i]);
            high[i] = Math.max(high[i], point[i]);
          }
        }
      }
      const step = 500;
      const from = low.map((x) => step * Math.floor((x - 200) / step)), to = high.map((x) => step * Math.ceil((x + 200) / step));
      const lines = [];
      for (let x = from[0]; x <= to[0]; x += step) lines.push(x, from[1], 0, x, to[1], 0);
      for (let y = from[1]; y <= to[1]; y += step) lines.push(from[0], y, 0, to[0], y, 0);
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(lines, 3));
      this.line.color.setStyle(css(palette.grid));
      return new THREE.LineSegments(geometry, this.line);
    }

    // From faint (no share) to full colour (all of it).
    shareColour(share) { return mix([213, 80, 0], mix(this.palette.ink, this.palette.paper, 0.35), share); }

    // ---- words over the scene

    drawLabels() {
      const pen = this.labels.getContext('2d');
      const { palette } = this;
      pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
      pen.clearRect(0, 0, this.width, this.height);
      pen.textBaseline = 'middle';
      // x_{abc} with a subscript; returns where the text ends.
      const write = (text, x, y, bold, measure = false) => {
        text.split(/_\{([^}]*)\}/).forEach((part, i) => {
          if (!part) return;
          const low = i % 2 === 1;
          pen.font = (bold ? '600 ' : '') + (low ? '10px' : '13px') + ' system-ui, sans-serif';
          if (!measure) {
            pen.lineJoin = 'round';
            pen.lineWidth = 4;
            pen.strokeStyle = css(palette.paper);
            pen.strokeText(part, x, y + (low ? 4 : 0));
            pen.fillStyle = css(palette.ink);
            pen.fillText(part, x, y + (low ? 4 : 0));
          }
          x += pen.measureText(part).width;
        });
        return x;
      };
      const line = (from, to, colour, width) => {
        pen.strokeStyle = css(colour);
        pen.lineWidth = width;
        pen.beginPath();
        pen.moveTo(...from);
        pen.lineTo(...to);
        pen.stroke();
      };
      const arrow = (from, to, colour, width, head) => {
        const away = Math.hypot(to[0] - from[0], to[1] - from[1]);
        const way = [(to[0] - from[0]) / away, (to[1] - from[1]) / away], wing = 0.42 * head;
        const neck = [to[0] - head * way[0], to[1] - head * way[1]];
        line(from, neck, colour, width);
        pen.fillStyle = css(colour);
        pen.beginPath();
        pen.moveTo(...to);
        pen.lineTo(neck[0] - wing * way[1], neck[1] + wing * way[0]);
        pen.lineTo(neck[0] + wing * way[1], neck[1] - wing * way[0]);
        pen.fill();
      };
      const origin = this.spotOf(this.data.origin);
      const long = (70 * this.view.high_mm) / this.height;
      ['x₀', 'y₀', 'z₀'].forEach((name, i) => {
        const tip = this.spotOf(add(this.data.origin, [0, 1, 2].map((k) => (k === i ? long : 0))));
        if (Math.hypot(tip[0] - origin[0], tip[1] - origin[1]) < 12) return;
        line(origin, tip, palette.ink, 2);
        write(name, tip[0] + 6, tip[1] - 4);
      });
      const taken = [];  // boxes that labels keep clear of
      const tip = loadTip(this.frame);
      if (tip) {
        const from = this.spotOf(this.frame.load_at), to = this.spotOf(tip);
        const along = Math.hypot(to[0] - from[0], to[1] - from[1]);
        if (along >= 12) {  // a load seen end on has no direction to draw
          arrow(from, to, palette.paper, 9, 20);
          arrow(from, to, palette.ink, 5, 17);
          for (let i = 0; i <= 8; ++i) {
            const at = [from[0] + (i / 8) * (to[0] - from[0]), from[1] + (i / 8) * (to[1] - from[1])];
            taken.push([at[0] - 7, at[1] - 7, at[0] + 7, at[1] + 7]);
          }
          const side = to[0] >= from[0] - 20 ? to[0] + 11 : to[0] - 11 - write('load', 0, 0, true, true);
          taken.push([side, to[1] - 5, write('load', side, to[1] + 4, true), to[1] + 13]);
        }
      }
      // A label stands beside its point, on the first side where it covers neither a point nor another label.
      for (const [x, y] of this.frame.points.map((point) => this.spotOf(point.at))) taken.push([x - 6, y - 6, x + 6, y + 6]);
      for (const point of this.frame.points) {
        const [x, y] = this.spotOf(point.at);
        const wide = write(point.label, 0, 0, true, true), low = 9;
        const places = [[x + 12, y], [x - 12 - wide, y], [x + 8, y - 18], [x + 8, y + 18], [x - 8 - wide, y - 18], [x - 8 - wide, y + 18],
          [x - wide / 2, y - 24], [x - wide / 2, y + 24]];
        const isFree = ([left, middle]) => left > 2 && left + wide < this.width - 2 &&
          !taken.some((box) => left < box[2] && left + wide > box[0] && middle - low < box[3] && middle + low > box[1]);
        const [left, middle] = places.find(isFree) || places[0];
        taken.push([left, middle - low, left + wide, middle + low]);
        write(point.label, left, middle, true);
        if (point.label !== this.picked) continue;
        pen.beginPath();
        pen.arc(x, y, 14, 0, 2 * Math.PI);
        pen.strokeStyle = css(palette.ink);
        pen.lineWidth = 2.5;
        pen.stroke();
      }
      if (this.data.vectors.length === 0) return;
      // A reference arrow: how long a vector is drawn.
      const pixels = (this.factorOf('m') * this.height) / this.view.high_mm;  // of a µm
      const reference = roundDown125(150 / pixels);
      const y = this.height - 14;
      line([12, y], [12 + reference * pixels, y], palette.ink, 3);
      const scale = (reference < 100 ? shortNumber(reference) + ' µm' : shortNumber(1e-3 * reference) + ' mm') + '   vectors × ' + shortNumber(this.magnification);
      const residuals = this.residualFactor !== 1 && this.shown.r ? 'residuals × ' + shortNumber(this.magnification * this.residualFactor) : '';
      const left = 22 + reference * pixels;
      // On a narrow screen the residuals' scale stands above.
      const beside = residuals ? scale + ', ' + residuals : scale;
      const fits = write(beside, left, y, false, true) < this.width - 4;
      write(fits ? beside : scale, left, y);
      if (!fits && residuals) write(residuals, 12, y - 18);
    }

    tell() {
      const { data, frame, palette } = this;
      const postures = data.frames.filter((one) => one.step === frame.step);
      const all = data.postures > postures.length ? '; the day has ' + data.postures : '';
      const parts = [frame.where + ' (' + (postures.indexOf(frame) + 1) + ' of ' + postures.length + all + ')'];
      if (frame.load) parts.push(frame.load);
      if (data.methods.length > 0) parts.push('predicted by ' + data.methods[this.method].name);
      this.status.textContent = (this.message || parts.join('   ·   '));
      this.message = '';
      this.postures.value = frame.id;
      if (this.steps) this.steps.value = String(frame.step);
      if (this.methods) this.methods.value = String(this.method);
      for (const vector of data.vectors) {
        this.boxes[vector.key].box.checked = this.shown[vector.key];
        this.boxes[vector.key].patch.style.background = css(palette[vector.colour]);
      }
      if (this.shareBox) this.shareBox.checked = this.byShare;
      this.live.classList.toggle('dark', this.dark);
      this.tellPoint();
      this.tellCaption();
    }

    // The caption is of the picture: where the scene shows another state, it says so, and the longest vector there.
    tellCaption() {
      const { data, frame } = this;
      const caption = this.figure.querySelector('figcaption');
      if (!this.now) this.now = element('span', { class: 'now' });
      this.now.textContent = '';
      if (this.at === data.first || !caption) return this.now.remove();
      let longest = null, of = '';
      for (const point of frame.points) {
        if (point.m && (!longest || norm(point.m) > norm(longest))) [longest, of] = [point.m, point.label];
      }
      const kind = data.vectors.find((vector) => vector.key === 'm');
      const step = frame.step !== data.frames[data.first].step && frame.load ? ' (' + frame.load + ')' : '';
      const most = longest && kind ? ', longest vector (' + kind.name + ') ' + (1e-3 * norm(longest)).toFixed(3) + '\u00a0mm, of ' + of : '';
      rich(this.now, 'In the scene now: ' + frame.where + step + most + '. The words before are of the picture.');
      caption.append(this.now);
    }

    // The numbers of the picked point, mm in R0.
    tellPoint() {
      this.numbers.textContent = '';
      const point = this.frame.points.find((one) => one.label === this.picked);
      if (!point) return;
      const table = element('table');
      rich(table.createCaption(), point.label + ' in ' + this.frame.where);
      const row = (cells) => {
        const line = table.insertRow();
        cells.forEach((cell, i) => rich(line.appendChild(i ? element('td') : element('th', { scope: 'row' })), cell));
      };
      row(['in R_{0}, mm', 'x_{0}', 'y_{0}', 'z_{0}', 'length']);
      const vectors = this.vectorsOf(point);
      for (const vector of this.data.vectors) {
        const v = vectors[vector.key];
        if (v) row([vector.name, ...v.map((x) => (1e-3 * x).toFixed(3)), (1e-3 * norm(v)).toFixed(3)]);
      }
      row(['stands at', ...sub(point.at, this.data.origin).map((x) => x.toFixed(1)), '']);
      if (this.frame.force) row(['force, N', ...this.frame.force.map((x) => x.toFixed(0)), norm(this.frame.force).toFixed(0)]);
      if (vectors.e) row(['share of the effects', '', '', '', (100 * this.shareOf(vectors)).toFixed(0) + ' %']);
      this.numbers.appendChild(table);
    }

    // ---- what a hand does

    // Tells the page's charts and tables, and other scenes, which posture is shown.
    announce() {
      document.dispatchEvent(new CustomEvent('stiffscope-posture',
        { detail: { campaign: this.data.campaign, posture: this.frame.id, from: this } }));
    }

    show(index) {
      this.at = index;
      this.draw();
      this.announce();
    }

    stepPosture(by) {
      const { frames } = this.data;
      for (let away = 1; away <= frames.length; ++away) {
        const at = (((this.at + by * away) % frames.length) + frames.length) % frames.length;
        if (frames[at].step === this.frame.step) return this.show(at);
      }
    }

    stepLoad(by) {
      const { frames } = this.data;
      for (let at = this.at + by; at >= 0 && at < frames.length; at += by) {
        if (frames[at].id === this.frame.id && frames[at].step !== this.frame.step) return this.show(at);
      }
      this.message = by > 0 ? 'this is the last load step' : 'this is the first load step';
      this.draw();
    }

    showStep(step) {
      const at = this.data.frames.findIndex((one) => one.step === step && one.id === this.frame.id);
      if (at >= 0) this.show(at);
    }

    showPosture(id, announced) {
      let at = this.data.frames.findIndex((one) => one.id === id && one.step === this.frame.step);
      if (at < 0) at = this.data.frames.findIndex((one) => one.id === id);
      if (at < 0 || at === this.at) return;
      this.at = at;
      this.draw();
      if (announced) this.announce();
    }

    pick(label) {
      this.picked = label;
      this.draw();
    }

    // Returns whether there was a next point.
    pickNext() {
      const points = this.frame.points;
      const next = points.findIndex((one) => one.label === this.picked) + 1;
      this.pick(next < points.length ? points[next].label : '');
      return next < points.length;
    }

    lengthen(factor) {
      this.magnification = Math.max(1e-3, Math.min(1e6, this.magnification * factor));
      this.draw();
    }

    suitLength() {
      let longest = 0;
      const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
      const include = (point) => point.forEach((x, i) => { low[i] = Math.min(low[i], x); high[i] = Math.max(high[i], x); });
      this.frame.joints.forEach(include);
      for (const point of this.frame.points) {
        include(point.at);
        const vectors = this.vectorsOf(point);
        for (const key of Object.keys(vectors)) {
          if (vectors[key] && this.shown[key]) longest = Math.max(longest, norm(vectors[key]) * (key === 'r' ? this.residualFactor : 1));
        }
      }
      const side = Math.max(...high.map((x, i) => x - low[i]));
      if (longest > 0) this.magnification = roundDown125(side / 5 / (1e-3 * longest));
      this.draw();
    }

    changeResiduals(longer) {
      this.residualFactor = Math.max(1, Math.min(1000, roundDown125(this.residualFactor * (longer ? 2.5 : 0.501))));
      this.draw();
    }

    look(view) {
      this.direction = view === 4 ? this.home : VIEWS[view];
      this.held = null;
      this.draw();
    }

    hold() { if (!this.held) this.held = { centre: this.view.centre, high_mm: this.view.high_mm }; }

    turn(aboutVertical, towards) {
      this.hold();
      this.direction = turned(this.direction, aboutVertical, towards);
      this.draw();
    }

    shift(right, up) {
      this.hold();
      const { axes } = this.view;
      this.held.centre = sub(this.held.centre, times(add(times(axes.right, right), times(axes.up, up)), this.held.high_mm / this.height));
      this.draw();
    }

    zoom(factor) {
      this.hold();
      this.held.high_mm = Math.max(1, Math.min(1e6, this.held.high_mm / factor));
      this.draw();
    }

    reset() {
      this.magnification = this.data.magnification;
      this.residualFactor = this.data.residual_factor;
      for (const vector of this.data.vectors) this.shown[vector.key] = vector.key !== 'e';
      this.byShare = false;
      this.picked = '';
      this.look(4);
    }

    toggleKeys() { this.keys.hidden = !this.keys.hidden; }

    toggle(key) {
      if (!(key in this.shown)) return;
      this.shown[key] = !this.shown[key];
      this.draw();
    }

    save() {
      const whole = element('canvas');
      whole.width = this.labels.width;
      whole.height = this.labels.height;
      const pen = whole.getContext('2d');
      pen.drawImage(this.canvas, 0, 0, whole.width, whole.height);
      pen.drawImage(this.labels, 0, 0);
      const link = element('a', { href: whole.toDataURL('image/png'), download: plain(this.frame.where).replace(/\W+/g, '-') + '.png' });
      link.click();
    }

    close() {
      this.closed = true;
      if (this.now) this.now.remove();
      this.figure.classList.remove('live');
      this.live.remove();
      this.renderer.dispose();
      offer(this.figure, this.data);
    }

    key(event) {
      if (event.ctrlKey || event.altKey || event.metaKey) return false;
      const turn = Math.PI / 18;
      if (event.shiftKey && event.key.startsWith('Arrow')) {
        const [about, towards] = { ArrowRight: [turn, 0], ArrowLeft: [-turn, 0], ArrowDown: [0, turn], ArrowUp: [0, -turn] }[event.key];
        this.turn(about, towards);
        return true;
      }
      const acts = {
        ArrowRight: () => this.stepPosture(1), ArrowLeft: () => this.stepPosture(-1), ArrowUp: () => this.stepLoad(1),
        ArrowDown: () => this.stepLoad(-1), m: () => this.toggle('m'), p: () => this.toggle('p'), r: () => this.toggle('r'),
        e: () => this.toggle('e'), c: () => { this.byShare = !this.byShare; this.draw(); }, '+': () => this.lengthen(2),
        '=': () => this.lengthen(2), '-': () => this.lengthen(0.5), _: () => this.lengthen(0.5), a: () => this.suitLength(),
        '.': () => this.changeResiduals(true), '>': () => this.changeResiduals(true), ',': () => this.changeResiduals(false),
        n: () => { this.method = (this.method + 1) % Math.max(1, this.data.methods.length); this.draw(); },
        1: () => this.look(1), 2: () => this.look(2), 3: () => this.look(3), 4: () => this.look(4), i: () => this.zoom(1.2),
        o: () => this.zoom(1 / 1.2), b: () => { this.dark = !this.dark; this.draw(); }, s: () => this.save(), 0: () => this.reset(),
        Home: () => this.reset(), h: () => this.toggleKeys(), '?': () => this.toggleKeys(), q: () => this.close(), Escape: () => this.close() };
      // Behind the last point Tab goes on to what comes next in the page.
      if (event.key === 'Tab') return !event.shiftKey && this.pickNext();
      if (!acts[event.key]) return false;
      acts[event.key]();
      return true;
    }

    bind() {
      this.canvas.addEventListener('keydown', (event) => { if (this.key(event)) event.preventDefault(); });
      let last = null, moved = 0;
      this.canvas.addEventListener('pointerdown', (event) => {
        last = [event.clientX, event.clientY];
        moved = 0;
        this.canvas.setPointerCapture(event.pointerId);
      });
      this.canvas.addEventListener('pointermove', (event) => {
        if (!last) return;
        const by = [event.clientX - last[0], event.clientY - last[1]];
        moved += Math.abs(by[0]) + Math.abs(by[1]);
        last = [event.clientX, event.clientY];
        if (event.buttons & 1) this.turn(0.008 * by[0], 0.008 * by[1]);
        else this.shift(by[0], -by[1]);
      });
      this.canvas.addEventListener('pointerup', (event) => {
        if (last && moved < 4 && event.button === 0) this.pickAt(event.offsetX, event.offsetY);
        last = null;
      });
      this.canvas.addEventListener('contextmenu', (event) => event.preventDefault());
      // The wheel zooms once the scene has the focus; else it scrolls the page.
      this.canvas.addEventListener('wheel', (event) => {
        if (document.activeElement !== this.canvas) return;
        event.preventDefault();
        this.zoom(Math.pow(1.2, -Math.sign(event.deltaY)));
      }, { passive: false });
      window.addEventListener('resize', () => this.draw());
      document.addEventListener('stiffscope-posture', (event) => {
        if (event.detail.from !== this && event.detail.campaign === this.data.campaign) this.showPosture(event.detail.posture, false);
      });
    }

    pickAt(x, y) {
      let nearest = '', least = 18;
      for (const point of this.frame.points) {
        const spot = this.spotOf(point.at);
        const away = Math.hypot(spot[0] - x, spot[1] - y);
        if (away < least) [nearest, least] = [point.label, away];
      }
      this.pick(nearest);
    }
  }

  // ---- where scenes stand

  const running = [];
  window.stiffscopeScenes = running;  // for tests and for those who look

  function start(figure, data) {
    return loadThree().then((THREE) => {
      const scene = new Scene(THREE, figure, data);
      scene.firstFrame_ms = performance.now() - opened;
      running.push(scene);
      return scene;
    }).catch((reason) => {
      figure.classList.remove('live');  // the picture stands
      figure.querySelectorAll('.scene-live, .offer').forEach((one) => one.remove());
      figure.dataset.scene = 'none: ' + reason.message;
    });
  }

  // A button on the picture that starts its scene.
  function offer(figure, data) {
    const button = element('button', { type: 'button', class: 'offer' }, 'Turn it in the hand');
    button.addEventListener('click', () => {
      button.remove();
      start(figure, data).then((scene) => scene && scene.canvas.focus());
    });
    figure.querySelector('.picture').after(button);
  }

  for (const script of scenes) {
    const figure = document.querySelector('figure#' + CSS.escape(script.dataset.figure));
    if (!figure) continue;
    const data = JSON.parse(script.textContent);
    const seen = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      seen.disconnect();
      start(figure, data);
    });
    seen.observe(figure);
  }
})();
