// SPDX-License-Identifier: GPL-2.0-or-later
// The picture of a run in a page: every element of the class masonry-view gets one, of the data inside it, which
// masonry/read/page/data.py has written. It draws with three.js, which must be loaded before, and asks the network nothing.
"use strict";

(function () {
  // -- data ------------------------------------------------------------------------------------------------------------

  const READERS = { u1: Uint8Array, u2: Uint16Array, i2: Int16Array, u4: Uint32Array, f4: Float32Array };

  /** The arrays of the page by name: {values, row, step}, as data.py wrote them. */
  async function unpack(text, known) {
    const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
    const found = {};
    for (const [name, { kind, at, count, row, step }] of Object.entries(known)) {
      const Reader = READERS[kind];
      const width = Reader.BYTES_PER_ELEMENT;
      const whole = new { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[width](count);
      for (let plane = 0; plane < width; ++plane)
        for (let i = 0; i < count; ++i) whole[i] |= bytes[at + plane * count + i] << (8 * plane);
      for (let i = row; i < count; ++i) whole[i] += whole[i - row];
      found[name] = { values: new Reader(whole.buffer), row, step };
    }
    return found;
  }

  // -- motion ----------------------------------------------------------------------------------------------------------

  /** How all rigid blocks move in a frame: of each its shift, and the matrix of its turn less the unit matrix, row by row. */
  function motions(data, frame) {
    const { shift, turn, bodies } = data;
    const found = new Float64Array(12 * bodies.values.length);
    for (let block = 0; block < bodies.values.length; ++block) {
      const from = frame * shift.row + 3 * block, at = 12 * block;
      const x = turn.values[from] * turn.step, y = turn.values[from + 1] * turn.step, z = turn.values[from + 2] * turn.step;
      const angle = Math.hypot(x, y, z);
      const first = angle > 1e-9 ? Math.sin(angle) / angle : 1;
      const second = angle > 1e-9 ? 2 * (Math.sin(angle / 2) / angle) ** 2 : 0.5;
      for (let k = 0; k < 3; ++k) found[at + k] = shift.values[from + k] * shift.step;
      found[at + 3] = -second * (y * y + z * z);
      found[at + 4] = second * x * y - first * z;
      found[at + 5] = second * x * z + first * y;
      found[at + 6] = second * x * y + first * z;
      found[at + 7] = -second * (x * x + z * z);
      found[at + 8] = second * y * z - first * x;
      found[at + 9] = second * x * z - first * y;
      found[at + 10] = second * y * z + first * x;
      found[at + 11] = -second * (x * x + y * y);
    }
    return found;
  }

  /** Adds to the n-th displacement of `to` a share of that of the n-th point, if it moved with a rigid block. */
  function addRigid(motion, centres, block, points, n, share, to) {
    const p = 3 * n, c = 3 * block, m = 12 * block;
    const x = points[p] - centres[c], y = points[p + 1] - centres[c + 1], z = points[p + 2] - centres[c + 2];
    for (let k = 0; k < 3; ++k) {
      const row = m + 3 + 3 * k;
      to[p + k] += share * (motion[m + k] + motion[row] * x + motion[row + 1] * y + motion[row + 2] * z);
    }
  }

  /** Displacements of the corners of all blocks in a frame, into `to`. */
  function moveBlocks(data, frame, motion, to) {
    to.fill(0);
    const { points, owner, free, moved, centres } = data;
    for (let n = 0; n < owner.values.length; ++n) addRigid(motion, centres.values, owner.values[n], points.values, n, 1, to);
    for (let i = 0; i < free.values.length; ++i)
      for (let k = 0; k < 3; ++k)
        to[3 * free.values[i] + k] = moved.values[frame * moved.row + 3 * i + k] * moved.step;
  }

  /** Displacements of the corners of all joints in a frame, into `to`: means of those of both blocks. */
  function moveJoints(data, frame, motion, to) {
    const { jointPoints, jointOwner, jointBlocks, jointMoved, centres } = data;
    if (jointMoved) {
      for (let i = 0; i < to.length; ++i) to[i] = jointMoved.values[frame * jointMoved.row + i] * jointMoved.step;
      return;
    }
    to.fill(0);
    for (let n = 0; n < jointOwner.values.length; ++n)
      for (let side = 0; side < 2; ++side) {
        const block = jointBlocks.values[2 * jointOwner.values[n] + side];
        addRigid(motion, centres.values, block, jointPoints.values, n, 0.5, to);
      }
  }

  // -- colours ---------------------------------------------------------------------------------------------------------

  const RAMPS = {
    opening: ["#f5b335", "#ec6b1c", "#c8191c", "#5c0011"],
    slide: ["#7cc0ee", "#2f83cf", "#184a9a", "#0a1c4e"],
    closure: ["#c9a0dc", "#9358b4", "#5c2483", "#260340"],
    damage: ["#f2c14e", "#d9772b", "#a23b5b", "#3d1259"],
    moved: ["#f3e3c8", "#a9cfa4", "#3f9aa0", "#1d3f77"],
  };
  const KINDS = { open: "#d62728", slid: "#1f77b4", crushed: "#101010" }; // as in cracks.png
  const TIES = ["#333333", "#ff7f0e"]; // elastic, has yielded; as in cracks.png
  const BRICK = "#f0debf", PLATEN = "#b9bdc2", EDGE = "#4d4437";
  const NAMES = {
    crack: "cracks: open or slid", opening: "opening", slide: "slide", closure: "plastic closure", damage: "damage",
    moved: "displacement", none: "none",
  };

  const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

  /** The colour of a share from 0 to 1 on a ramp: [r, g, b] from 0 to 255. */
  function colourOf(ramp, share) {
    const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
    const low = Math.min(Math.floor(at), ramp.length - 2);
    const [a, b] = [rgb(ramp[low]), rgb(ramp[low + 1])];
    return a.map((v, k) => Math.round(v + (b[k] - v) * (at - low)));
  }

  /** A number in three digits, as a person writes it. */
  function digits(value) {
    const text = Math.abs(value) >= 1000 ? value.toFixed(0) : value.toPrecision(3);
    return text.includes("e") ? String(Number(text)) : text.replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
  }

  // -- shaders ---------------------------------------------------------------------------------------------------------

  const BLOCKS = [
    `uniform float magnify;
     attribute vec3 moved; attribute float brick;
     varying vec3 eye; varying float how, far;
     void main() {
       vec4 seen = modelViewMatrix * vec4(position + magnify * moved, 1.0);
       eye = seen.xyz; how = brick; far = length(moved);
       gl_Position = projectionMatrix * seen;
     }`,
    `uniform vec3 plain, platen, ramp[4]; uniform float most; uniform bool coloured;
     varying vec3 eye; varying float how, far;
     void main() {
       vec3 side = normalize(cross(dFdx(eye), dFdy(eye)));
       if (side.z < 0.0) side = -side;
       float light = 0.66 + 0.40 * max(dot(side, normalize(vec3(0.25, 0.55, 0.8))), 0.0);
       vec3 colour = how > 0.5 ? plain : platen;
       if (coloured) {
         float at = clamp(far / most, 0.0, 1.0) * 3.0;
         colour = at < 1.0 ? mix(ramp[0], ramp[1], at) : at < 2.0 ? mix(ramp[1], ramp[2], at - 1.0) : mix(ramp[2], ramp[3], at - 2.0);
       }
       gl_FragColor = vec4(min(colour * light, 1.0), 1.0);
     }`,
  ];
  const EDGES = [
    `uniform float magnify, nearer;
     attribute vec3 moved;
     void main() {
       vec4 seen = modelViewMatrix * vec4(position + magnify * moved, 1.0);
       seen.z += 0.4 * nearer; // rims of joints lie before them
       gl_Position = projectionMatrix * seen;
     }`,
    "uniform vec3 colour; uniform float strength; void main() { gl_FragColor = vec4(colour, strength); }",
  ];
  const FACES = [
    `uniform float magnify;
     attribute vec3 moved; attribute vec4 colour;
     varying vec3 shown;
     void main() {
       shown = colour.rgb;
       gl_Position = projectionMatrix * modelViewMatrix * vec4(position + magnify * moved, 1.0);
       if (colour.a < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
     }`,
    "varying vec3 shown; void main() { gl_FragColor = vec4(shown, 1.0); }",
  ];
  // A rim is a ribbon that faces the viewer: `position` has which end it is, and to which side of the line.
  const RIMS = [
    `uniform float magnify, nearer, wide; uniform vec2 pixels;
     attribute vec3 a, b, movedA, movedB; attribute vec4 colour;
     varying vec3 shown;
     void main() {
       vec4 p = projectionMatrix * (modelViewMatrix * vec4(a + magnify * movedA, 1.0) + vec4(0.0, 0.0, nearer, 0.0));
       vec4 q = projectionMatrix * (modelViewMatrix * vec4(b + magnify * movedB, 1.0) + vec4(0.0, 0.0, nearer, 0.0));
       vec2 along = (q.xy - p.xy) * pixels;
       float length = max(length(along), 1e-6);
       along /= length;
       vec2 off = (vec2(-along.y, along.x) * position.y + along * (position.x - 0.5) * 0.7) * wide;
       gl_Position = position.x < 0.5 ? p : q;
       gl_Position.xy += off / pixels;
       shown = colour.rgb;
       if (colour.a < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
     }`,
    "varying vec3 shown; void main() { gl_FragColor = vec4(shown, 1.0); }",
  ];

  // -- elements --------------------------------------------------------------------------------------------------------

  function make(tag, settings = {}, ...inner) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(settings)) {
      if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
      else element.setAttribute(name, value);
    }
    element.append(...inner);
    return element;
  }

  const KEYS =
    "Drag to turn, drag with the right button, with Shift or with two fingers to move, wheel or pinch to zoom. In the picture: " +
    "arrows turn, Shift and arrows move, + and − zoom, Page Up and Page Down change the frame, space plays, Home shows all, " +
    "1 to 4 are the views. A click on a block says which it is and how it moved.";

  // -- the picture -----------------------------------------------------------------------------------------------------

  class View {
    constructor(element, head, data) {
      this.head = head;
      this.data = data;
      this.element = element;
      this.frame = head.first;
      this.magnify = head.magnification;
      this.joints = "crack";
      this.blocks = "none";
      this.middle = [0, 1, 2].map((k) => (head.low[k] + head.high[k]) / 2);
      this.draw = this.draw.bind(this);
      this.stage = make("div", { class: "masonry-stage" });
      this.canvas = make("canvas", { tabindex: "0", role: "img", "aria-label": head.title + ". " + KEYS });
      this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
      this.renderer.setClearColor(0, 0);
      this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
      this.camera.up.set(0, 0, 1);
      this.build();
      this.overlay();
      this.controls();
      element.replaceChildren(this.stage, this.panel);
      this.listen();
      this.look(head.flat ? "start" : "iso");
      this.show(this.frame);
    }

    /** Meshes of all that is drawn. */
    build() {
      const { data, head } = this;
      const own = (name) => data[name].values;
      this.scene = new THREE.Scene();
      this.shared = { magnify: { value: this.magnify }, nearer: { value: 0 } };
      const colour = (hex) => ({ value: new THREE.Color(hex) });
      const shader = ([vertexShader, fragmentShader], uniforms, more = {}) =>
        new THREE.ShaderMaterial({ vertexShader, fragmentShader, side: THREE.DoubleSide, uniforms: { ...this.shared, ...uniforms }, ...more });
      const add = (Kind, geometry, material) => {
        const mesh = new Kind(geometry, material);
        mesh.frustumCulled = false;
        this.scene.add(mesh);
        return mesh;
      };
      // blocks and their edges share points
      const points = new THREE.BufferAttribute(own("points"), 3);
      this.moved = new THREE.BufferAttribute(new Float32Array(own("points").length), 3);
      const brick = Uint8Array.from(own("owner"), (block) => own("brick")[block]);
      const body = new THREE.BufferGeometry();
      body.setAttribute("position", points);
      body.setAttribute("moved", this.moved);
      body.setAttribute("brick", new THREE.BufferAttribute(brick, 1));
      body.setIndex(new THREE.BufferAttribute(own("triangles"), 1));
      this.looks = {
        plain: colour(BRICK), platen: colour(PLATEN), most: { value: head.ramp }, coloured: { value: false },
        ramp: { value: RAMPS.moved.map((hex) => new THREE.Color(hex)) },
      };
      const polygon = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
      this.bodies = add(THREE.Mesh, body, shader(BLOCKS, this.looks, { extensions: { derivatives: true }, ...polygon }));
      const lines = new THREE.BufferGeometry();
      lines.setAttribute("position", points);
      lines.setAttribute("moved", this.moved);
      lines.setIndex(new THREE.BufferAttribute(own("edges"), 1));
      this.edges = { colour: colour(EDGE), strength: { value: 1 } };
      add(THREE.LineSegments, lines, shader(EDGES, this.edges, { transparent: true }));
      // as built: the same edges, not moved
      const still = shader(EDGES, { colour: colour("#808890"), strength: { value: 0.45 } }, { transparent: true, depthWrite: false });
      still.uniforms.magnify = { value: 0 };
      this.still = add(THREE.LineSegments, lines, still);
      this.still.visible = false;
      // joints: faces, and rims, which show where a joint meets the outside of a wall
      const owner = own("jointOwner"), corners = own("jointPoints");
      this.jointMoved = new THREE.BufferAttribute(new Float32Array(corners.length), 3);
      this.jointColour = new THREE.BufferAttribute(new Uint8Array((corners.length / 3) * 4), 4, true);
      const fans = [], sides = [];
      for (let start = 0; start < owner.length; ) {
        let end = start;
        while (end < owner.length && owner[end] === owner[start]) ++end;
        for (let n = start; n < end; ++n) {
          if (n > start && n + 1 < end) fans.push(start, n, n + 1);
          sides.push(n, n + 1 < end ? n + 1 : start);
        }
        start = end;
      }
      const faces = new THREE.BufferGeometry();
      faces.setAttribute("position", new THREE.BufferAttribute(corners, 3));
      faces.setAttribute("moved", this.jointMoved);
      faces.setAttribute("colour", this.jointColour);
      faces.setIndex(new THREE.BufferAttribute(new Uint32Array(fans), 1));
      this.sides = sides;
      this.rims = { wide: { value: 1 }, pixels: { value: new THREE.Vector2(1, 1) } };
      this.cracks = [];
      if (sides.length) {
        const rims = this.ribbons(corners, sides);
        [this.rimMoved, this.rimColour] = [rims.moved, rims.colour];
        this.cracks = [add(THREE.Mesh, faces, shader(FACES, {})), add(THREE.Mesh, rims.geometry, shader(RIMS, this.rims))];
      }
      if (data.tiePoints) {
        this.ties = this.ribbons(own("tiePoints"), Array.from({ length: own("tiePoints").length / 3 }, (_, n) => n));
        add(THREE.Mesh, this.ties.geometry, shader(RIMS, this.rims));
      }
    }

    /** Lines as ribbons that face the viewer.
     *  @param points of their ends, three numbers each
     *  @param pairs of numbers of points, one after the other
     */
    ribbons(points, pairs) {
      const geometry = new THREE.InstancedBufferGeometry(), count = pairs.length / 2;
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([0, -1, 0, 0, 1, 0, 1, 1, 0, 1, -1, 0]), 3));
      geometry.setIndex([0, 1, 2, 0, 2, 3]);
      const instance = (array, size, normal = false) => new THREE.InstancedBufferAttribute(array, size, normal);
      const ends = [0, 1].map((side) => {
        const found = new Float32Array(count * 3);
        for (let i = 0; i < count; ++i)
          for (let k = 0; k < 3; ++k) found[3 * i + k] = points[3 * pairs[2 * i + side] + k];
        return found;
      });
      const moved = ends.map((array) => instance(new Float32Array(array.length), 3));
      const colour = instance(new Uint8Array(count * 4), 4, true);
      geometry.setAttribute("a", instance(ends[0], 3));
      geometry.setAttribute("b", instance(ends[1], 3));
      geometry.setAttribute("movedA", moved[0]);
      geometry.setAttribute("movedB", moved[1]);
      geometry.setAttribute("colour", colour);
      return { geometry, moved, colour };
    }

    /** Ties in a frame: where their ends are, and a colour by what they did. Those that are broken are not drawn. */
    showTies() {
      const { tieMoved, tieCondition } = this.data, { moved, colour } = this.ties;
      for (let i = 0; i < colour.count; ++i) {
        for (let side = 0; side < 2; ++side)
          for (let k = 0; k < 3; ++k)
            moved[side].array[3 * i + k] = tieMoved.values[this.frame * tieMoved.row + 6 * i + 3 * side + k] * tieMoved.step;
        const condition = tieCondition.values[this.frame * tieCondition.row + i];
        colour.array.set([...rgb(TIES[Math.min(condition, 1)]), condition === 2 ? 0 : 255], 4 * i);
      }
      moved[0].needsUpdate = moved[1].needsUpdate = colour.needsUpdate = true;
    }

    /** Legend, scale, axes and what is said about the frame. */
    overlay() {
      const over = (name) => make("div", { class: "masonry-over " + name });
      this.says = over("masonry-says");
      this.says.setAttribute("aria-live", "polite");
      this.legend = over("masonry-legend");
      this.scale = over("masonry-scale");
      this.axes = over("masonry-axes");
      this.stage.append(this.canvas, this.says, this.legend, this.scale, this.axes);
    }

    controls() {
      const { head } = this;
      const range = (min, max, step, value, on) => make("input", { type: "range", min, max, step, value, oninput: on });
      const choice = (names, value, on) => {
        const found = make("select", { onchange: () => on(found.value) }, ...names.map((n) => make("option", { value: n }, NAMES[n])));
        found.value = value;
        return found;
      };
      const button = (text, on, label = text) => make("button", { type: "button", title: label, "aria-label": label, onclick: on }, text);
      this.slider = range(0, head.frames.length - 1, 1, this.frame, () => { this.stop(); this.show(Number(this.slider.value)); });
      this.slider.setAttribute("aria-label", "frame");
      this.frameText = make("output");
      this.playing = button("▶", () => this.play(), "play the frames");
      // the slider of the magnification goes by powers of ten
      const least = 1, most = Math.max(1000, 10 * head.magnification);
      this.magnifier = range(0, 1000, 1, 0, () => {
        const at = Number(this.magnifier.value) / 1000;
        this.setMagnify(at ? least * (most / least) ** at : least);
      });
      this.magnifier.setAttribute("aria-label", "magnification of displacements");
      this.magnifyText = make("output");
      this.setMagnify = (value) => {
        this.magnify = value < 10 ? Math.round(value * 10) / 10 : Math.round(value);
        this.magnifier.value = (1000 * Math.log(Math.max(this.magnify, least) / least)) / Math.log(most / least);
        this.magnifyText.textContent = "× " + this.magnify;
        this.shared.magnify.value = this.magnify;
        this.ask();
      };
      const built = make("input", { type: "checkbox", onchange: () => { this.still.visible = built.checked; this.ask(); } });
      this.panel = make("div", { class: "masonry-controls" },
        make("label", { class: "frames" }, this.playing, this.slider, this.frameText),
        make("label", {}, "displacements", this.magnifier, this.magnifyText),
        make("label", {}, "joints", choice(["crack", "opening", "slide", "damage", "closure", "none"], this.joints, (v) => { this.joints = v; this.colour(); })),
        make("label", {}, "blocks", choice(["none", "moved"], this.blocks, (v) => { this.blocks = v; this.colour(); })),
        make("label", {}, built, "as built"),
        make("span", { role: "group", "aria-label": "views" },
          ...[["Front", "front"], ["Side", "side"], ["Top", "top"], ["Iso", "iso"]].map(([text, name]) => button(text, () => this.look(name), "view: " + name))),
        make("details", {}, make("summary", {}, "Mouse, touch and keys"), KEYS +
          ` Of ${head.jointPoints.toLocaleString("en")} points of joints, the ${head.keptPoints.toLocaleString("en")} that crack, slide or close in some frame are drawn.`));
      this.panel.querySelectorAll("select")[1].options[0].textContent = "plain";
      this.slider.disabled = this.playing.disabled = head.frames.length < 2;
      this.setMagnify(head.magnification);
    }

    // -- frames

    /** Shows a frame. */
    show(frame) {
      const { data, head } = this;
      this.frame = Math.min(Math.max(frame, 0), head.frames.length - 1);
      const motion = motions(data, this.frame);
      moveBlocks(data, this.frame, motion, this.moved.array);
      moveJoints(data, this.frame, motion, this.jointMoved.array);
      this.moved.needsUpdate = this.jointMoved.needsUpdate = true;
      if (this.ties) this.showTies();
      (this.rimMoved || []).forEach((attribute, side) => {
        for (let i = 0; i < this.sides.length / 2; ++i)
          for (let k = 0; k < 3; ++k) attribute.array[3 * i + k] = this.jointMoved.array[3 * this.sides[2 * i + side] + k];
        attribute.needsUpdate = true;
      });
      const about = head.frames[this.frame];
      this.slider.value = this.frame;
      this.frameText.textContent = `${this.frame + 1} of ${head.frames.length}`;
      const stage = about.stage ? `stage ${about.stage}, ` : "";
      this.says.replaceChildren(make("b", {}, `${stage}${digits(about.time)} s`), ...about.values.map((text) => make("div", {}, text)));
      if (this.picked !== undefined) this.says.append(make("div", {}, this.about(this.picked)));
      this.slider.setAttribute("aria-valuetext", [`frame ${this.frame + 1}`, `${digits(about.time)} s`, ...about.values].join(", "));
      this.colour();
      this.element.dispatchEvent(new CustomEvent("masonryframe", { bubbles: true, detail: this.frame }));
    }

    play() {
      if (this.timer) return this.stop();
      const last = this.head.frames.length - 1;
      if (this.frame >= last) this.show(0);
      this.playing.textContent = "❚❚";
      const pause = Math.min(Math.max(6000 / (last + 1), 50), 400);
      this.timer = setInterval(() => {
        if (this.frame >= last) this.stop();
        else this.show(this.frame + 1);
      }, pause);
    }

    stop() {
      clearInterval(this.timer);
      this.timer = undefined;
      this.playing.textContent = "▶";
    }

    // -- colours

    /** Colours of joints and blocks, and the legend. */
    colour() {
      const { data, head, joints } = this;
      const paint = new Uint8Array(data.jointBlocks.values.length * 2); // four bytes a point of a joint
      const at = (name, n) => data[name].values[this.frame * data[name].row + n] * data[name].step;
      const kinds = [head.kinds.open, head.kinds.slid, head.kinds.crushed].map((bit) => (kind) => (kind & bit) > 0);
      const plain = Object.fromEntries(Object.entries(KINDS).map(([name, hex]) => [name, rgb(hex)]));
      const shades = joints in RAMPS && Array.from({ length: 256 }, (_, n) => colourOf(RAMPS[joints], n / 255));
      for (let n = 0; n < paint.length / 4; ++n) {
        let found;
        if (joints === "crack") {
          const kind = data.kind.values[this.frame * data.kind.row + n];
          const name = kinds[2](kind) ? "crushed" : kinds[0](kind) ? "open" : kinds[1](kind) ? "slid" : null;
          found = name && plain[name];
        } else if (shades) {
          const value = at(joints, n), { least, top } = head.values[joints];
          found = value > least && shades[Math.min(255, Math.round((255 * value) / top))];
        }
        if (!found) continue;
        for (let k = 0; k < 3; ++k) paint[4 * n + k] = found[k];
        paint[4 * n + 3] = 255;
      }
      const owner = data.jointOwner.values;
      const give = (attribute, count, from) => {
        for (let i = 0; i < count; ++i) {
          const n = 4 * owner[from(i)];
          for (let k = 0; k < 4; ++k) attribute.array[4 * i + k] = paint[n + k];
        }
        attribute.needsUpdate = true;
      };
      give(this.jointColour, owner.length, (i) => i);
      if (this.rimColour) give(this.rimColour, this.sides.length / 2, (i) => this.sides[2 * i]);
      this.cracks.forEach((mesh) => { mesh.visible = joints !== "none"; });
      this.looks.coloured.value = this.blocks === "moved";
      this.tell();
      this.ask();
    }

    /** The legend: what colours mean, with units. */
    tell() {
      const parts = [];
      const swatch = (hex, text) => make("div", {}, make("span", { class: "swatch", style: "background:" + hex }), text);
      const bar = (name, title, least, top, most, factor) => {
        const ramp = Array.from({ length: 17 }, (_, n) => `rgb(${colourOf(RAMPS[name], n / 16)})`).join(",");
        const marks = make("div", { class: "marks" });
        for (let n = 0; n <= 4; ++n) {
          const beyond = n === 4 && most > top * (1 + 1e-6) ? "≥ " : "";
          marks.append(make("span", { style: `bottom:${25 * n}%` }, beyond + digits((n / 4) * top * factor)));
        }
        const note = least ? [make("div", {}, `from ${digits(least * factor)}`)] : [];
        return make("section", {}, title, make("div", { class: "bar" },
          make("div", { class: "ramp", style: `background:linear-gradient(to top,${ramp})` }), marks), ...note);
      };
      if (this.joints === "crack") {
        const limit = digits(1e3 * this.head.limits.crack), crushed = digits(1e3 * this.head.limits.crushed);
        parts.push(make("section", {}, swatch(KINDS.open, `open > ${limit} mm`), swatch(KINDS.slid, `slid > ${limit} mm`), swatch(KINDS.crushed, `closed > ${crushed} mm`)));
      } else if (this.joints !== "none") {
        const { least, top, most } = this.head.values[this.joints];
        const [unit, factor] = this.joints === "damage" ? ["–", 1] : ["mm", 1e3];
        parts.push(bar(this.joints, `${NAMES[this.joints]} [${unit}]`, least, top, most, factor));
      }
      if (this.blocks === "moved") parts.push(bar("moved", "displacement [mm]", 0, this.head.ramp, 0, 1e3));
      if (this.ties) parts.push(make("section", {}, swatch(TIES[0], "tie"), swatch(TIES[1], "tie that has yielded")));
      this.legend.replaceChildren(...parts);
      this.legend.hidden = !parts.length;
    }

    // -- the viewer's place

    /** One of the standard views, with all in it. */
    look(name) {
      const front = Math.atan2(this.head.towards[1], this.head.towards[0]);
      const place = {
        front: [0, 0], start: [-0.17, 0.13], side: [Math.PI / 2, 0], top: [0, Math.PI / 2], iso: [-Math.PI / 4, Math.asin(1 / Math.sqrt(3))],
      }[name];
      this.azimuth = front + place[0];
      this.elevation = place[1];
      this.target = new THREE.Vector3(...this.middle);
      this.zoom = 1;
      this.ask();
    }

    /** Directions of the picture: to the right, up, and to the viewer. */
    directions() {
      const [a, e] = [this.azimuth, this.elevation];
      return [
        new THREE.Vector3(-Math.sin(a), Math.cos(a), 0),
        new THREE.Vector3(-Math.cos(a) * Math.sin(e), -Math.sin(a) * Math.sin(e), Math.cos(e)),
        new THREE.Vector3(Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)),
      ];
    }

    turn(right, up) {
      this.azimuth -= right;
      this.elevation = Math.min(Math.max(this.elevation + up, -Math.PI / 2), Math.PI / 2);
      this.ask();
    }

    /** Moves what is seen by pixels. */
    move(right, down) {
      const [x, y] = this.directions();
      this.target.addScaledVector(x, -right * this.metres).addScaledVector(y, down * this.metres);
      this.ask();
    }

    /** Zooms about a place in the picture, in pixels from the place of the target. */
    enlarge(factor, right = 0, down = 0) {
      const now = Math.min(Math.max(this.zoom * factor, 0.2), 200);
      const gain = 1 - this.zoom / now;
      const [x, y] = this.directions();
      this.target.addScaledVector(x, right * this.metres * gain).addScaledVector(y, -down * this.metres * gain);
      this.zoom = now;
      this.ask();
    }

    // -- mouse, touch, keys

    listen() {
      const { canvas } = this;
      const down = new Map();
      const middle = () => { const all = [...down.values()]; return [0, 1].map((k) => all.reduce((sum, p) => sum + p[k], 0) / all.length); };
      const apart = () => { const [p, q] = down.values(); return Math.hypot(p[0] - q[0], p[1] - q[1]); };
      const place = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left - box.width / 2 + this.beside, event.clientY - box.top - box.height / 2]; };
      let travelled = 0;
      canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        down.set(event.pointerId, place(event));
        travelled = down.size > 1 ? Infinity : 0;
      });
      canvas.addEventListener("pointermove", (event) => {
        if (!down.has(event.pointerId)) return;
        const before = middle(), wide = down.size === 2 && apart();
        down.set(event.pointerId, place(event));
        const now = middle(), [x, y] = [now[0] - before[0], now[1] - before[1]];
        travelled += Math.hypot(x, y);
        if (down.size === 2) {
          this.move(x, y);
          if (wide > 0) this.enlarge(apart() / wide, ...now);
        } else if (event.shiftKey || event.buttons & 6) this.move(x, y);
        else this.turn(x / 180, y / 180);
      });
      const lift = (event) => {
        if (event.type === "pointerup" && down.has(event.pointerId) && travelled < 4 && event.button === 0) this.pick(place(event));
        down.delete(event.pointerId);
      };
      for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, lift);
      canvas.addEventListener("contextmenu", (event) => event.preventDefault());
      canvas.addEventListener("wheel", (event) => {
        event.preventDefault();
        const lines = event.deltaMode === 1 ? 33 : 1;
        this.enlarge(Math.exp(-event.deltaY * lines * 0.0015), ...place(event));
      }, { passive: false });
      canvas.addEventListener("keydown", (event) => {
        const step = event.shiftKey ? (x, y) => this.move(-40 * x, -40 * y) : (x, y) => this.turn(0.1 * x, 0.1 * y);
        const views = { 1: "front", 2: "side", 3: "top", 4: "iso" };
        const act = {
          ArrowLeft: () => step(-1, 0), ArrowRight: () => step(1, 0), ArrowUp: () => step(0, -1), ArrowDown: () => step(0, 1),
          "+": () => this.enlarge(1.2), "=": () => this.enlarge(1.2), "-": () => this.enlarge(1 / 1.2),
          PageUp: () => this.show(this.frame - 1), PageDown: () => this.show(this.frame + 1),
          " ": () => this.play(), Home: () => this.look(this.head.flat ? "start" : "iso"),
        }[event.key] || (views[event.key] && (() => this.look(views[event.key])));
        if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        act();
      });
      new ResizeObserver(() => this.ask()).observe(this.stage);
      addEventListener("beforeprint", this.draw);
      canvas.addEventListener("webglcontextlost", (event) => { event.preventDefault(); });
      canvas.addEventListener("webglcontextrestored", () => this.ask());
    }

    /** Says of the block at a place how it moved; of the background, nothing more. */
    pick([right, down]) {
      const [x, y, z] = this.directions();
      const eye = this.target.clone().addScaledVector(x, right * this.metres).addScaledVector(y, -down * this.metres).addScaledVector(z, 1e3 * this.size);
      const to = z.clone().negate();
      const { points, triangles, owner } = this.data, moved = this.moved.array;
      const corner = (n, to) => to.set(...[0, 1, 2].map((k) => points.values[3 * n + k] + this.magnify * moved[3 * n + k]));
      const ray = new THREE.Ray(eye, to), hit = new THREE.Vector3();
      const [a, b, c] = [0, 1, 2].map(() => new THREE.Vector3());
      let nearest = Infinity;
      this.picked = undefined;
      for (let t = 0; t < triangles.values.length; t += 3) {
        const n = triangles.values[t];
        if (!ray.intersectTriangle(corner(n, a), corner(triangles.values[t + 1], b), corner(triangles.values[t + 2], c), false, hit)) continue;
        const far = hit.distanceToSquared(eye);
        if (far < nearest) [nearest, this.picked] = [far, owner.values[n]];
      }
      this.show(this.frame);
    }

    about(block) {
      const { owner, bodies, centres } = this.data, moved = this.moved.array, sum = [0, 0, 0];
      let count = 0;
      owner.values.forEach((own, n) => {
        if (own !== block) return;
        ++count;
        for (let k = 0; k < 3; ++k) sum[k] += moved[3 * n + k];
      });
      const millimetres = sum.map((v) => (1e3 * v) / count);
      const place = [0, 1, 2].map((k) => digits(centres.values[3 * block + k])).join(", ");
      return `block ${bodies.values[block]} at (${place}) m has moved by (${millimetres.map(digits).join(", ")}) mm`;
    }

    // -- drawing

    /** Draws soon, once, however often it is asked. */
    ask() {
      if (!this.asked) this.asked = requestAnimationFrame(this.draw);
    }

    draw() {
      this.asked = undefined;
      const wide = this.stage.clientWidth, high = this.stage.clientHeight;
      if (!wide || !high || !this.target) return;
      const dots = Math.min(devicePixelRatio || 1, 3), narrow = wide < 560;
      this.element.classList.toggle("narrow", narrow); // the legend stands below then, not beside
      const drawn = this.renderer.getSize(new THREE.Vector2());
      if (drawn.x !== wide || drawn.y !== high || this.renderer.getPixelRatio() !== dots) {
        this.renderer.setPixelRatio(dots);
        this.renderer.setSize(wide, high, false);
      }
      // all of the structure is in the picture at zoom 1, with a rim
      const [x, y, z] = this.directions();
      const extent = (axis) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(axis.getComponent(k)) * (this.head.high[k] - this.head.low[k]), 0);
      this.size = Math.max(...[0, 1, 2].map((k) => this.head.high[k] - this.head.low[k]));
      this.metres = Math.max((1.18 * extent(y)) / high, (1.12 * extent(x)) / (narrow ? wide : wide - 150), 1e-9) / this.zoom;
      const { camera } = this, deep = 20 * this.size + this.magnify * this.head.farthest;
      this.beside = narrow ? 0 : 60; // how far the middle of the structure is beside that of the picture, for the legend [pixels]
      const [w, h] = [(wide * this.metres) / 2, (high * this.metres) / 2];
      const aside = this.beside * this.metres;
      Object.assign(camera, { left: aside - w, right: aside + w, top: h, bottom: -h, near: 0, far: 2 * deep });
      camera.position.copy(this.target).addScaledVector(z, deep);
      camera.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, y, z));
      camera.updateProjectionMatrix();
      const course = this.head.course / this.metres; // [pixels]
      const line = Math.min(Math.max(0.13 * course, 1.1), 3.5); // half of the width of a rim is half of this
      this.rims.wide.value = line * 0.5 * dots;
      this.rims.pixels.value.set((wide * dots) / 2, (high * dots) / 2);
      this.shared.nearer.value = Math.min(0.03 * this.head.course + 1.2 * line * this.metres, 0.4 * this.head.course);
      this.edges.strength.value = Math.min(Math.max(course / 16, 0.12), 0.85);
      this.renderer.render(this.scene, camera);
      this.drawScale(wide);
      this.drawAxes(x, y);
    }

    drawScale(wide) {
      const most = 0.22 * wide * this.metres, power = 10 ** Math.floor(Math.log10(most));
      const length = [5, 2, 1].find((n) => n * power <= most) * power;
      const text = length >= 1 ? `${digits(length)} m` : `${digits(1e3 * length)} mm`;
      this.scale.replaceChildren(`${text}, displacements × ${this.magnify}`, make("i", { style: `width:${length / this.metres}px;margin:2px auto 0` }));
    }

    drawAxes(x, y) {
      const lines = ["x", "y", "z"].map((name, k) => {
        const [right, up] = [x.getComponent(k), y.getComponent(k)];
        return Math.hypot(right, up) < 0.25 ? "" :
          `<line x1="0" y1="0" x2="${24 * right}" y2="${-24 * up}"/><text x="${32 * right}" y="${-32 * up}">${name}</text>`;
      });
      this.axes.innerHTML = `<svg viewBox="-38 -38 76 76" aria-hidden="true">${lines.join("")}</svg>`;
    }
  }

  // -- start -----------------------------------------------------------------------------------------------------------

  /** Whether this browser draws in 3-D; a sentence that says why not, else null. */
  function lacking() {
    if (typeof THREE === "undefined") return "This page lacks three.js, which draws the picture; make the page anew.";
    if (typeof DecompressionStream === "undefined") return "This browser is too old for the picture: it needs one of 2023 or later.";
    const context = document.createElement("canvas").getContext("webgl");
    if (!context) return "This browser shows no 3-D pictures, because WebGL is switched off or missing on this machine. Another browser or machine may show it.";
    for (const name of ["OES_standard_derivatives", "OES_element_index_uint", "ANGLE_instanced_arrays"])
      if (!context.getExtension(name)) return `This browser cannot draw the picture: its WebGL has no ${name}.`;
    context.getExtension("WEBGL_lose_context").loseContext();
    return null;
  }

  /** Makes the picture of an element of the class masonry-view. Returns a promise of the View, or of null without one. */
  async function start(element) {
    const note = element.querySelector(".masonry-note");
    const problem = lacking();
    if (problem) {
      note.textContent = problem;
      return null;
    }
    note.textContent = "The picture is being drawn.";
    const [head, numbers] = [...element.querySelectorAll("script")].map((script) => script.textContent);
    try {
      const known = JSON.parse(head);
      return new View(element, known, await unpack(numbers, known.arrays));
    } catch (error) {
      element.replaceChildren(make("p", { class: "masonry-note" }, `The picture cannot be drawn: ${error.message}`));
      return null;
    }
  }

  /** All pictures of the page: promises of a View each, by the order of their elements. */
  window.masonryViews = [];
  const all = () => { for (const element of document.querySelectorAll(".masonry-view")) window.masonryViews.push(start(element)); };
  if (document.readyState === "loading") addEventListener("DOMContentLoaded", all);
  else all();
})();
