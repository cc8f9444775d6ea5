// Draws mode shapes of face gears with WebGL 2 from the packed JSON of facegear/report/viewers.py, with what viewer.js holds.
"use strict";
(() => {
  // u = Re[e^(i (phase - order angle)) (U, i V, W)]; of a standing wave the phase is that of the motion alone
  const VERTEX = `#version 300 es
    uniform mat4 camera; uniform float order, phase, swing; uniform bool standing;
    in vec3 point; in vec3 shape;
    out vec3 place; out float moved;
    void main() {
      float turn = order * point.z, at = standing ? -turn : phase - turn;
      vec3 u = swing * (standing ? cos(phase) : 1.0) * vec3(shape.x * cos(at), -shape.y * sin(at), shape.z * cos(at));
      vec2 along = vec2(cos(point.z), sin(point.z)), across = vec2(-along.y, along.x);
      place = vec3((point.x + u.x) * along + u.y * across, point.y + u.z);
      moved = swing > 0.0 ? length(u) / swing : 0.0;
      gl_Position = camera * vec4(place, 1.0);
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float;
    uniform vec3 scale[9]; uniform vec3 eye;
    in vec3 place; in float moved; out vec4 shown;
    void main() {
      vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
      float light = 0.55 + 0.45 * abs(dot(normal, normalize(eye + vec3(0.3, -0.2, 0.5))));
      float at = clamp(moved, 0.0, 1.0) * 8.0;
      shown = vec4(light * mix(scale[int(at)], scale[min(int(at) + 1, 8)], fract(at)), 1.0);
    }`;
  const ROUND = 180, SECONDS = 2.5, CODE = 32767;

  async function start(root) {
    const uniforms = ["camera", "order", "phase", "swing", "standing", "scale", "eye"];
    const viewer = await opened(root, VERTEX, FRAGMENT, ["point", "shape"], uniforms);
    if (!viewer) return;
    const { canvas, gl, data, find, places } = viewer;

    // the outline of the section, turned about the axis
    for (const gear of Object.values(data.gears)) {
      const outline = decoded(gear.points, "f"), count = outline.length / 2;
      const points = new Float32Array(3 * ROUND * count), indices = [];
      for (let k = 0; k < ROUND; k++)
        for (let i = 0; i < count; i++) {
          points.set([outline[2 * i], outline[2 * i + 1], (2 * Math.PI * k) / ROUND], 3 * (k * count + i));
          const a = k * count + i, b = k * count + ((i + 1) % count), next = (((k + 1) % ROUND) - k) * count;
          indices.push(a, b, b + next, a, b + next, a + next);
        }
      Object.assign(gear, surface(gl, points, indices), { shapes: changing(gl, ROUND * count), held: null });
    }

    const home = { azimuth: -2.1, height: 0.72, zoom: 0.62 };
    const view = { ...home };
    let pending = false, moving = false, phase = 0, last = 0;

    function loaded(mode) {
      const gear = data.gears[mode.gear];
      gl.bindVertexArray(gear.array);
      if (gear.held === mode) return gear;
      const shape = Float32Array.from(decoded(mode.shape, "h"), (value) => value / CODE);
      const around = new Float32Array(ROUND * shape.length);
      for (let k = 0; k < ROUND; k++) around.set(shape, k * shape.length);
      gl.bindBuffer(gl.ARRAY_BUFFER, gear.shapes);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, around);
      gear.held = mode;
      return gear;
    }

    function draw(time) {
      pending = false;
      if (moving) { phase += ((time - last) / 1000) * ((2 * Math.PI) / SECONDS); last = time; }
      cleared(gl, canvas);
      const mode = data.modes[+find("mode").value], gear = loaded(mode);
      const swing = (data.swing * data.factor * +find("swing").value) / 100;
      const { matrix, back } = cameraMatrix(view, [0, 0, 0], data.size, canvas.width / canvas.height);
      gl.uniformMatrix4fv(places.camera, false, matrix);
      gl.uniform3f(places.eye, ...back);
      gl.uniform1f(places.order, mode.order);
      gl.uniform1f(places.phase, phase);
      gl.uniform1f(places.swing, swing);
      gl.uniform1i(places.standing, mode.order > 0 && find("wave").value === "standing" ? 1 : 0);
      gl.drawElements(gl.TRIANGLES, gear.count, gl.UNSIGNED_INT, 0);
      const words = mode.order === 1 ? "nodal diameter" : "nodal diameters";
      root.querySelector("output").textContent =
        `${mode.gear} face gear, hub held: ${mode.order} ${words}, mode ${mode.number}, ${mode.frequency_hz} Hz at rest. ` +
        `Largest motion drawn: ${swing.toFixed(0)} mm, exaggerated.`;
      if (moving) redraw();
    }

    function redraw() {
      if (!pending) { pending = true; requestAnimationFrame(draw); }
    }

    steered(canvas, find, view, home, redraw);
    for (const name of ["swing", "mode", "wave"]) find(name).addEventListener("input", redraw);
    find("move").addEventListener("click", (event) => {
      moving = !moving;
      last = performance.now();
      event.target.textContent = moving ? "Stop" : "Move";
      redraw();
    });
    redraw();
  }

  watch("body", start);
})();
