// SPDX-License-Identifier: GPL-2.0-or-later
// The picture of a run in a page: every element of the class masonry-view gets one, of the data inside it, which
// data.py beside this file has written. It draws with three.js, which must be loaded before, and asks the network nothing.
"use strict";

(function () {
  const READERS = { u1: Uint8Array, u2: Uint16Array, i2: Int16Array, u4: Uint32Array, f4: Float32Array };

  /** The arrays of the page by name: {values, row, step}, as data.py wrote them; a row is what one frame has. */
  async function unpack(text, arrays) {
    const packed = Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = await new Response(stream).arrayBuffer();
    return Object.fromEntries(Object.entries(arrays).map(([name, { kind, at, count, row, step }]) =>
      [name, { values: new READERS[kind](bytes, at, count), row, step }]));
  }

  const RAMPS = {
    opening: ["#f5b335", "#ec6b1c", "#c8191c", "#5c0011"],
    slide: ["#7cc0ee", "#2f83cf", "#184a9a", "#0a1c4e"],
    closure: ["#c9a0dc", "#9358b4", "#5c2483", "#260340"],
    damage: ["#f2c14e", "#d9772b", "#a23b5b", "#3d1259"],
    moved: ["#f3e3c8", "#a9cfa4", "#3f9aa0", "#1d3f77"],
  };
  const EDGE = "#4d4437", WAS = "#808890";
  const NAMES = {
    crack: "cracks: open or slid", opening: "opening", slide: "slide", closure: "plastic closure", damage: "damage",
    moved: "displacement", none: "none", plain: "plain",
  };

  /** The colour of a share from 0 to 1 on a ramp. */
  function colourOf(ramp, share) {
    const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
    const low = Math.min(Math.floor(at), ramp.length - 2);
    return new THREE.Color(ramp[low]).lerp(new THREE.Color(ramp[low + 1]), at - low);
  }

  /** A number in three digits, as a person writes it. */
  function digits(value) {
    const text = Math.abs(value) >= 1000 ? value.toFixed(0) : value.toPrecision(3);
    return text.includes("e") ? String(Number(text)) : text.replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
  }

  /** The geometry of points that have a colour each. */
  function coloured(points, colours) {
    return new THREE.BufferGeometry().setAttribute("position", points).setAttribute("color", colours);
  }

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
    "Drag to turn, drag with the right button or with two fingers to move, wheel or pinch to zoom. In the picture: arrows turn, " +
    "Shift and arrows move, + and − zoom, Page Up and Page Down change the frame, space plays, Home shows all, 1 to 4 are the " +
    "views. A click on a block says which it is and how it moved.";
  const LEAST_ZOOM = 0.2, MOST_ZOOM = 200;
  const ASIDE = 60; // how far the middle of the structure is beside that of a wide picture, for the legend [pixels]

  class View {
    constructor(element, head, data) {
      Object.assign(this, { element, head, data, frame: head.first, magnify: head.magnification, joints: "crack", blocks: "plain" });
      this.stage = make("div", { class: "masonry-stage" });
      this.canvas = make("canvas", { tabindex: "0", role: "img", "aria-label": head.title + ". " + KEYS });
      const over = (name) => make("div", { class: "masonry-over " + name });
      [this.says, this.legend, this.scale, this.axes] = ["masonry-says", "masonry-legend", "masonry-scale", "masonry-axes"].map(over);
      this.says.setAttribute("aria-live", "polite");
      this.stage.append(this.canvas, this.says, this.legend, this.scale, this.axes);
      this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
      this.renderer.setClearColor(0, 0);
      this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
      this.camera.up.set(0, 0, 1);
      this.orbit = new THREE.OrbitControls(this.camera, this.canvas);
      // keys do more here, and a wall follows the mouse up and down, too
      Object.assign(this.orbit, { enableKeys: false, screenSpacePanning: true, minZoom: LEAST_ZOOM, maxZoom: MOST_ZOOM });
      this.orbit.addEventListener("change", () => this.ask());
      this.build();
      element.replaceChildren(this.stage, this.controls());
      this.listen();
      this.look(head.flat ? "start" : "iso");
      this.show(this.frame);
    }

    /** What is drawn: blocks with their edges, edges as built, faces and rims of joints, ties. */
    build() {
      const values = (name) => this.data[name].values;
      this.scene = new THREE.Scene();
      const sun = new THREE.DirectionalLight("#ffffff", 0.42);
      sun.position.set(0.25, 0.55, 0.8);
      this.camera.add(sun, sun.target);
      this.scene.add(this.camera, new THREE.AmbientLight("#ffffff", 0.66));
      const add = (thing, order) => Object.assign(thing, { frustumCulled: false, renderOrder: order });
      // blocks and their edges share points; blocks are drawn a little behind, so that lines on them are seen
      [this.places, this.shades] = [0, 1].map(() => new THREE.BufferAttribute(new Float32Array(values("points").length), 3));
      const body = coloured(this.places, this.shades);
      body.setIndex(new THREE.BufferAttribute(values("triangles"), 1));
      body.boundingSphere = new THREE.Sphere(new THREE.Vector3(), Infinity); // for clicks: blocks move
      this.bodies = add(new THREE.Mesh(body, new THREE.MeshPhongMaterial({
        vertexColors: THREE.VertexColors, flatShading: true, shininess: 0, side: THREE.DoubleSide,
        polygonOffset: true, polygonOffsetFactor: 2.5, polygonOffsetUnits: 4,
      })), 0);
      const edges = new THREE.BufferAttribute(values("edges"), 1), built = new THREE.BufferAttribute(values("points"), 3);
      const [lines, was] = [this.places, built].map((points) => new THREE.BufferGeometry().setAttribute("position", points));
      [lines, was].forEach((geometry) => geometry.setIndex(edges));
      this.edges = add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: EDGE, transparent: true })), 1);
      this.was = add(new THREE.LineSegments(was, new THREE.LineBasicMaterial({ color: WAS, transparent: true, opacity: 0.45, depthWrite: false })), 2);
      this.was.visible = false;
      const both = { side: THREE.DoubleSide, vertexColors: THREE.VertexColors };
      this.faces = add(new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial(both)), 3);
      const line = () => new THREE.LineMaterial({ vertexColors: THREE.VertexColors, polygonOffset: true, polygonOffsetFactor: 0, polygonOffsetUnits: -8 });
      [this.rims, this.ties] = [4, 5].map((order) => add(new THREE.LineSegments2(new THREE.LineSegmentsGeometry(), line()), order));
      this.scene.add(this.bodies, this.edges, this.was, this.faces, this.rims, this.ties);
      // where the corners of each point of a joint begin
      const owner = values("jointOwner");
      this.starts = [...owner.keys()].filter((n) => owner[n] !== owner[n - 1]).concat(owner.length);
    }

    controls() {
      const { head } = this;
      const range = (label, most, on) => make("input", { type: "range", min: 0, max: most, step: 1, "aria-label": label, oninput: on });
      const choice = (names, on) => {
        const menu = make("select", { onchange: () => on(menu.value) }, ...names.map((n) => make("option", { value: n }, NAMES[n])));
        return menu;
      };
      const button = (text, on, label = text) => make("button", { type: "button", title: label, "aria-label": label, onclick: on }, text);
      this.slider = range("frame", head.frames.length - 1, () => { this.stop(); this.show(Number(this.slider.value)); });
      this.frameText = make("output");
      this.playing = button("▶", () => this.play(), "play the frames");
      // the slider of the magnification goes by powers of ten, up to `most`
      const most = Math.max(1000, 10 * head.magnification);
      const magnifier = range("magnification of displacements", 1000, () => { set(most ** (magnifier.value / 1000)); this.show(this.frame); });
      const text = make("output");
      const set = (value) => {
        this.magnify = value < 10 ? Math.round(value * 10) / 10 : Math.round(value);
        text.textContent = "× " + this.magnify;
      };
      magnifier.value = (1000 * Math.log(Math.max(head.magnification, 1))) / Math.log(most);
      set(head.magnification);
      const built = make("input", { type: "checkbox", onchange: () => { this.was.visible = built.checked; this.ask(); } });
      this.slider.disabled = this.playing.disabled = head.frames.length < 2;
      return make("div", { class: "masonry-controls" },
        make("label", { class: "frames" }, this.playing, this.slider, this.frameText),
        make("label", {}, "displacements", magnifier, text),
        make("label", {}, "joints", choice(["crack", "opening", "slide", "damage", "closure", "none"], (v) => { this.joints = v; this.show(this.frame); })),
        make("label", {}, "blocks", choice(["plain", "moved"], (v) => { this.blocks = v; this.show(this.frame); })),
        make("label", {}, built, "as built"),
        make("span", { role: "group", "aria-label": "views" },
          ...["Front", "Side", "Top", "Iso"].map((name) => button(name, () => this.look(name.toLowerCase()), "view: " + name.toLowerCase()))),
        make("details", {}, make("summary", {}, "Mouse, touch and keys"), KEYS +
          ` Of ${head.jointPoints.toLocaleString("en")} points of joints, the ${head.keptPoints.toLocaleString("en")} that crack, slide or close in some frame are drawn.`));
    }

    /** Shows a frame. */
    show(frame) {
      const { head } = this;
      this.frame = Math.min(Math.max(frame, 0), head.frames.length - 1);
      this.placeBlocks();
      this.placeJoints();
      if (this.data.tiePoints) this.placeTies();
      const about = head.frames[this.frame];
      const values = [`${about.stage ? `stage ${about.stage}, ` : ""}${digits(about.time)} s`, ...about.values];
      this.slider.value = this.frame;
      this.frameText.textContent = `${this.frame + 1} of ${head.frames.length}`;
      this.says.replaceChildren(...values.map((text, n) => make(n ? "div" : "b", {}, text)));
      if (this.picked !== undefined) this.says.append(make("div", {}, this.about(this.picked)));
      this.slider.setAttribute("aria-valuetext", [`frame ${this.frame + 1}`, ...values].join(", "));
      this.tell();
      this.ask();
      this.element.dispatchEvent(new CustomEvent("masonryframe", { bubbles: true, detail: this.frame }));
    }

    /** Of an array with a row a frame: a vector, or a number, of the present frame. */
    vector(name, n) {
      const { values, row, step } = this.data[name], at = this.frame * row + 3 * n;
      return new THREE.Vector3(values[at], values[at + 1], values[at + 2]).multiplyScalar(step);
    }
    number(name, n) {
      const { values, row, step } = this.data[name];
      return values[this.frame * row + n] * step;
    }

    placeBlocks() {
      const { data } = this, points = data.points.values, owner = data.owner.values;
      this.moved = new Float32Array(points.length);
      this.turns = Array.from(data.looks.values, (_, block) => {
        const turn = this.vector("turn", block), angle = turn.length();
        return new THREE.Quaternion().setFromAxisAngle(turn.normalize(), angle);
      });
      this.shifts = this.turns.map((_, block) => this.vector("shift", block));
      for (let n = 0; n < owner.length; ++n) this.carried(owner[n], points, n).toArray(this.moved, 3 * n);
      data.free.values.forEach((n, i) => this.vector("moved", i).toArray(this.moved, 3 * n));
      this.places.array.forEach((_, i, to) => { to[i] = points[i] + this.magnify * this.moved[i]; });
      const plain = this.head.colours.looks.map((hex) => new THREE.Color(hex));
      for (let n = 0; n < owner.length; ++n) {
        const far = Math.hypot(...this.moved.subarray(3 * n, 3 * n + 3));
        (this.blocks === "moved" ? colourOf(RAMPS.moved, far / this.head.ramp) : plain[data.looks.values[owner[n]]]).toArray(this.shades.array, 3 * n);
      }
      this.places.needsUpdate = this.shades.needsUpdate = true;
    }

    /** Displacement of the n-th of some points, which moves with a rigid block. */
    carried(block, points, n) {
      const arm = new THREE.Vector3().fromArray(points, 3 * n).sub(new THREE.Vector3().fromArray(this.data.centres.values, 3 * block));
      return arm.clone().applyQuaternion(this.turns[block]).sub(arm).add(this.shifts[block]);
    }

    /** Joints on the faces of both of their blocks: what is seen of them in the present frame. */
    placeJoints() {
      const { data, starts } = this, built = data.jointPoints.values, blocks = data.jointBlocks.values;
      const faces = [], shades = [], rims = [], rimShades = [];
      for (let point = 0; point + 1 < starts.length; ++point) {
        const shade = this.shadeOf(point);
        if (!shade) continue;
        for (const side of [0, 1]) {
          const corners = [];
          for (let n = starts[point]; n < starts[point + 1]; ++n) {
            const moved = data.jointMoved ? this.vector("jointMoved", side * starts[starts.length - 1] + n) : this.carried(blocks[2 * point + side], built, n);
            corners.push(moved.multiplyScalar(this.magnify).add(new THREE.Vector3().fromArray(built, 3 * n)).toArray());
          }
          corners.forEach((corner, n) => {
            rims.push(...corner, ...corners[(n + 1) % corners.length]);
            rimShades.push(...shade, ...shade);
            if (n < 2) return;
            faces.push(...corners[0], ...corners[n - 1], ...corner);
            shades.push(...shade, ...shade, ...shade);
          });
        }
      }
      this.shown = rims.length / 6; // sides of faces that are seen
      this.faces.geometry.dispose();
      this.faces.geometry = coloured(new THREE.Float32BufferAttribute(faces, 3), new THREE.Float32BufferAttribute(shades, 3));
      this.draft(this.rims, rims, rimShades);
    }

    /** Gives lines their ends, six numbers each, and the colours of these. */
    draft(lines, ends, shades) {
      lines.visible = ends.length > 0;
      if (!lines.visible) return;
      lines.geometry.dispose();
      lines.geometry = new THREE.LineSegmentsGeometry();
      lines.geometry.setPositions(ends);
      lines.geometry.setColors(shades);
    }

    /** The colour of a point of a joint in the present frame, three numbers from 0 to 1; null if it is not drawn. */
    shadeOf(point) {
      const { joints, head } = this;
      if (joints === "none") return null;
      if (joints === "crack") {
        const kind = this.number("kind", point);
        const name = ["crushed", "open", "slid"].find((one) => kind & head.kinds[one]);
        return name ? new THREE.Color(head.colours[name]).toArray() : null;
      }
      const value = this.number(joints, point), { least, top } = head.values[joints];
      return value > least ? colourOf(RAMPS[joints], value / top).toArray() : null;
    }

    /** Ties in the present frame, with a colour by what they did. Those that are broken are not drawn. */
    placeTies() {
      const built = this.data.tiePoints.values, ends = [], shades = [];
      for (let tie = 0; tie < built.length / 6; ++tie) {
        const condition = this.number("tieCondition", tie);
        if (condition === 2) continue;
        for (const n of [2 * tie, 2 * tie + 1]) {
          ends.push(...this.vector("tieMoved", n).multiplyScalar(this.magnify).add(new THREE.Vector3().fromArray(built, 3 * n)).toArray());
          shades.push(...new THREE.Color(this.head.colours.ties[condition]).toArray());
        }
      }
      this.draft(this.ties, ends, shades);
    }

    play() {
      if (this.timer) return this.stop();
      const last = this.head.frames.length - 1;
      if (this.frame >= last) this.show(0);
      this.playing.textContent = "❚❚";
      const pause = Math.min(Math.max(6000 / (last + 1), 50), 400);
      this.timer = setInterval(() => (this.frame >= last ? this.stop() : this.show(this.frame + 1)), pause);
    }

    stop() {
      this.timer = clearInterval(this.timer); // undefined
      this.playing.textContent = "▶";
    }

    /** The legend: what colours mean, with units. */
    tell() {
      const { head, joints } = this, parts = [];
      const swatch = (hex, text) => make("div", {}, make("span", { class: "swatch", style: "background:" + hex }), text);
      const bar = (name, title, least, top, most, factor) => {
        const ramp = Array.from({ length: 17 }, (_, n) => colourOf(RAMPS[name], n / 16).getStyle()).join(",");
        const marks = [0, 1, 2, 3, 4].map((n) =>
          make("span", { style: `bottom:${25 * n}%` }, (n === 4 && most > top * (1 + 1e-6) ? "≥ " : "") + digits((n / 4) * top * factor)));
        return make("section", {}, title, make("div", { class: "bar" },
          make("div", { class: "ramp", style: `background:linear-gradient(to top,${ramp})` }), make("div", { class: "marks" }, ...marks)),
          least ? make("div", {}, `from ${digits(least * factor)}`) : "");
      };
      if (joints === "crack") {
        const [limit, crushed] = [head.limits.crack, head.limits.crushed].map((value) => digits(1e3 * value));
        parts.push(make("section", {}, swatch(head.colours.open, `open > ${limit} mm`), swatch(head.colours.slid, `slid > ${limit} mm`), swatch(head.colours.crushed, `closed > ${crushed} mm`)));
      } else if (joints !== "none") {
        const { least, top, most } = head.values[joints];
        const [unit, factor] = joints === "damage" ? ["–", 1] : ["mm", 1e3];
        parts.push(bar(joints, `${NAMES[joints]} [${unit}]`, least, top, most, factor));
      }
      if (this.blocks === "moved") parts.push(bar("moved", "displacement [mm]", 0, head.ramp, 0, 1e3));
      if (this.data.tiePoints) parts.push(make("section", {}, swatch(head.colours.ties[0], "tie"), swatch(head.colours.ties[1], "tie that has yielded")));
      this.legend.replaceChildren(...parts);
      this.legend.hidden = !parts.length;
    }

    /** One of the standard views, with all in it. */
    look(name) {
      const { low, high, towards } = this.head;
      const [turn, rise] = {
        front: [0, 0], start: [-0.17, 0.13], side: [Math.PI / 2, 0], top: [0, Math.PI / 2 - 1e-4], iso: [-Math.PI / 4, 0.6155],
      }[name];
      const around = Math.atan2(towards[1], towards[0]) + turn;
      this.target = this.orbit.target.set(...[0, 1, 2].map((k) => (low[k] + high[k]) / 2));
      this.deep = 20 * Math.max(...[0, 1, 2].map((k) => high[k] - low[k])) + this.magnify * this.head.farthest;
      this.camera.position.set(Math.cos(around) * Math.cos(rise), Math.sin(around) * Math.cos(rise), Math.sin(rise));
      this.camera.position.multiplyScalar(this.deep).add(this.target);
      this.camera.zoom = 1;
      this.fitted = undefined;
      this.orbit.update();
      this.ask();
    }

    /** Directions of the picture: to the right, up, and to the viewer. */
    directions() {
      return [0, 1, 2].map((column) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, column));
    }

    turn(right, up) {
      const [across] = this.directions();
      this.camera.position.sub(this.target).applyAxisAngle(across, -up).applyAxisAngle(this.camera.up, -right).add(this.target);
      this.orbit.update();
    }

    /** Moves what is seen by pixels. */
    move(right, up) {
      const [x, y] = this.directions();
      const arm = x.multiplyScalar(-right * this.metres).addScaledVector(y, -up * this.metres);
      for (const point of [this.target, this.camera.position]) point.add(arm);
      this.orbit.update();
    }

    zoom(factor) {
      this.camera.zoom = Math.min(Math.max(this.camera.zoom * factor, LEAST_ZOOM), MOST_ZOOM);
      this.ask();
    }

    listen() {
      const { canvas } = this, pressed = { clientX: 0, clientY: 0 };
      canvas.addEventListener("mousedown", ({ clientX, clientY }) => Object.assign(pressed, { clientX, clientY }));
      canvas.addEventListener("click", (event) => {
        if (Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) < 4) this.pick(event);
      });
      canvas.addEventListener("keydown", (event) => {
        const step = event.shiftKey ? (x, y) => this.move(40 * x, 40 * y) : (x, y) => this.turn(0.1 * x, 0.1 * y);
        const act = {
          ArrowLeft: () => step(-1, 0), ArrowRight: () => step(1, 0), ArrowUp: () => step(0, 1), ArrowDown: () => step(0, -1),
          "+": () => this.zoom(1.2), "=": () => this.zoom(1.2), "-": () => this.zoom(1 / 1.2),
          PageUp: () => this.show(this.frame - 1), PageDown: () => this.show(this.frame + 1), " ": () => this.play(),
          Home: () => this.look(this.head.flat ? "start" : "iso"),
          1: () => this.look("front"), 2: () => this.look("side"), 3: () => this.look("top"), 4: () => this.look("iso"),
        }[event.key];
        if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        act();
      });
      new ResizeObserver(() => { this.fitted = undefined; this.ask(); }).observe(this.stage);
      addEventListener("beforeprint", () => this.draw());
      canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
      canvas.addEventListener("webglcontextrestored", () => this.ask());
    }

    /** Says of the block at a place how it moved; of the background, nothing more. */
    pick(event) {
      const box = this.canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
      ray.setFromCamera({ x: (2 * (event.clientX - box.left)) / box.width - 1, y: 1 - (2 * (event.clientY - box.top)) / box.height }, this.camera);
      const [nearest] = ray.intersectObject(this.bodies);
      this.picked = nearest && this.data.owner.values[nearest.face.a];
      this.show(this.frame);
    }

    about(block) {
      const { owner, bodies, centres } = this.data;
      const corners = [...owner.values.keys()].filter((n) => owner.values[n] === block);
      const mean = [0, 1, 2].map((k) => corners.reduce((sum, n) => sum + this.moved[3 * n + k], 0) / corners.length);
      const text = (values) => values.map(digits).join(", ");
      return `block ${bodies.values[block]} at (${text([...centres.values.subarray(3 * block, 3 * block + 3)])}) m has moved by (${text(mean.map((v) => 1e3 * v))}) mm`;
    }

    /** Draws soon, once, however often it is asked. */
    ask() {
      if (!this.asked) this.asked = requestAnimationFrame(() => this.draw());
    }

    draw() {
      this.asked = undefined;
      const wide = this.stage.clientWidth, high = this.stage.clientHeight;
      if (!wide || !high || !this.target) return;
      const { camera, head } = this, dots = Math.min(devicePixelRatio || 1, 3), narrow = wide < 560, aside = narrow ? 0 : ASIDE;
      this.element.classList.toggle("narrow", narrow); // the legend stands below then, not beside
      this.renderer.setPixelRatio(dots);
      const drawn = this.renderer.getSize(new THREE.Vector2());
      if (drawn.x !== wide || drawn.y !== high) this.renderer.setSize(wide, high, false);
      if (!this.fitted) {
        // all of the structure is in the picture, with a rim
        const extent = (axis) => [0, 1, 2].reduce((sum, k) => sum + Math.abs(axis.getComponent(k)) * (head.high[k] - head.low[k]), 0);
        camera.updateMatrix();
        const [x, y] = this.directions();
        this.fitted = Math.max((1.18 * extent(y)) / high, (1.12 * extent(x)) / (narrow ? wide : wide - 150), 1e-9);
      }
      const [left, right, top] = [aside - wide / 2, aside + wide / 2, high / 2].map((pixels) => pixels * this.fitted);
      Object.assign(camera, { left, right, top, bottom: -top, near: 0, far: 2 * this.deep });
      camera.updateProjectionMatrix();
      this.metres = this.fitted / camera.zoom; // of a pixel
      const course = head.course / this.metres; // [pixels]
      for (const lines of [this.rims, this.ties]) {
        lines.material.linewidth = Math.min(Math.max(0.13 * course, 1.4), 3.5);
        lines.material.resolution.set(wide, high);
      }
      this.edges.material.opacity = Math.min(Math.max(course / 16, 0.12), 0.85);
      this.renderer.render(this.scene, camera);
      this.drawScale(wide);
      this.drawAxes();
    }

    drawScale(wide) {
      const most = 0.22 * wide * this.metres, power = 10 ** Math.floor(Math.log10(most));
      const length = [5, 2, 1].find((n) => n * power <= most) * power;
      const text = length >= 1 ? `${digits(length)} m` : `${digits(1e3 * length)} mm`;
      this.scale.replaceChildren(`${text}, displacements × ${this.magnify}`, make("i", { style: `width:${length / this.metres}px;margin:2px auto 0` }));
    }

    drawAxes() {
      const [x, y] = this.directions();
      const lines = ["x", "y", "z"].map((name, k) => {
        const [right, up] = [x.getComponent(k), y.getComponent(k)];
        return Math.hypot(right, up) < 0.25 ? "" :
          `<line x1="0" y1="0" x2="${24 * right}" y2="${-24 * up}"/><text x="${32 * right}" y="${-32 * up}">${name}</text>`;
      });
      this.axes.innerHTML = `<svg viewBox="-38 -38 76 76" aria-hidden="true">${lines.join("")}</svg>`;
    }
  }

  /** A sentence that says why this browser draws nothing in 3-D, or null. */
  function lacking() {
    if (typeof THREE === "undefined") return "This page lacks three.js, which draws the picture; make the page anew.";
    if (typeof DecompressionStream === "undefined") return "This browser is too old for the picture: it needs one of 2023 or later.";
    const context = document.createElement("canvas").getContext("webgl");
    if (!context) return "This browser shows no 3-D pictures, because WebGL is switched off or missing on this machine. Another browser or machine may show it.";
    context.getExtension("WEBGL_lose_context").loseContext();
    return null;
  }

  /** Makes the picture of an element of the class masonry-view. Returns a promise of the View, or of null without one. */
  async function start(element) {
    const reason = lacking();
    element.querySelector(".masonry-note").textContent = reason || "The picture is being drawn.";
    if (reason) return null;
    const [text, numbers] = [...element.querySelectorAll("script")].map((script) => script.textContent);
    try {
      const head = JSON.parse(text);
      return new View(element, head, await unpack(numbers, head.arrays));
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
