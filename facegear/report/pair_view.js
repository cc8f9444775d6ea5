// Draws the pair in mesh with WebGL 2 from the packed JSON inside it (facegear/report/viewers.py),
// with what viewer.js holds.
"use strict";
(() => {
  const VERTEX = `#version 300 es
    uniform mat4 camera; uniform mat3 turn; uniform vec3 shift;
    in vec3 point; in vec3 load;
    out vec3 place; out vec3 carried;
    void main() { place = turn * point + shift; carried = load; gl_Position = camera * vec4(place, 1.0); }`;
  const FRAGMENT = `#version 300 es
    precision highp float;
    uniform vec4 colour; uniform bool painted; uniform vec3 scale[9]; uniform vec3 eye;
    in vec3 place; in vec3 carried; out vec4 shown;
    void main() {
      vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
      float light = 0.45 + 0.55 * abs(dot(normal, normalize(eye + vec3(0.3, -0.2, 0.5))));
      if (!painted) { shown = vec4(colour.rgb * light, colour.a); return; }
      if (carried.y < 0.35) discard;
      if (carried.z < 0.5 * carried.y) { shown = vec4(vec3(0.62), 1.0); return; }
      float at = clamp(carried.x / carried.z, 0.0, 1.0) * 8.0;
      shown = vec4(mix(scale[int(at)], scale[min(int(at) + 1, 8)], fract(at)), 1.0);
    }`;
  const COLOURS = { pinion: [0.82, 0.6, 0.33], face_gear: [0.42, 0.56, 0.72] };

  function cells([rows, columns], start = 0) {
    const found = [];
    for (let i = 0; i + 1 < rows; i++)
      for (let j = 0; j + 1 < columns; j++) {
        const a = start + i * columns + j, b = a + columns;
        found.push(a, b, b + 1, a, b + 1, a + 1);
      }
    return found;
  }

  // about -y for the pinion, -z for the gear, as in facegear/teeth/design.py, then to where the body stands; columns first
  function turned({ name, matrix }, angle) {
    const c = Math.cos(angle), s = Math.sin(angle);
    const about = name === "pinion" ? [c, 0, s, 0, 1, 0, -s, 0, c] : [c, -s, 0, s, c, 0, 0, 0, 1];
    return about.map((_, k) => [0, 1, 2].reduce((sum, i) => sum + matrix[3 * (k % 3) + i] * about[k - (k % 3) + i], 0));
  }

  async function start(root) {
    const uniforms = ["camera", "turn", "shift", "colour", "painted", "scale", "eye"];
    const viewer = await opened(root, VERTEX, FRAGMENT, ["point", "load"], uniforms);
    if (!viewer) return;
    const { canvas, gl, data, find, places } = viewer;

    for (const body of data.bodies) {
      const points = [], indices = [];
      for (const patch of body.patches) {
        indices.push(...cells(patch.shape, points.length / 3));
        points.push(...decoded(patch.points, "f"));
      }
      body.tooth = surface(gl, new Float32Array(points), indices);
    }
    // values that change from picture to picture: of every point its value, whether it carries, whether one is known
    function painted(points, indices) {
      const found = surface(gl, points, indices);
      return Object.assign(found, { values: new Float32Array(points.length), buffer: changing(gl, points.length / 3) });
    }
    const flank = painted(decoded(data.lattice.points, "f"), cells(data.lattice.shape));
    const [rows, columns] = data.lattice.shape, nodes = rows * columns;
    for (const { fillets } of data.bodies) {
      if (!fillets) continue;
      const points = decoded(fillets.points, "f"), half = points.length / 6;
      fillets.drawn = painted(points, [...cells(fillets.shape), ...cells(fillets.shape, half)]);
    }
    for (const found of data.torques) {
      Object.assign(found, { node: decoded(found.node, "H"), tooth: decoded(found.tooth, "b") });
      for (const key of Object.keys(found.values)) found.values[key] = decoded(found.values[key], "B");
      for (const name of Object.keys(found.tension)) found.tension[name] = decoded(found.tension[name], "B");
    }
    const quantity = () => data.quantities[+find("quantity").value];

    const [pinion, gear] = data.bodies;
    const home = { azimuth: -2.35, height: 0.62, zoom: 1.6 };
    const view = { ...home };
    let pending = false, moving = 0;

    function drawBody(body, angle, alpha) {
      gl.bindVertexArray(body.tooth.array);
      gl.uniform4f(places.colour, ...COLOURS[body.name], alpha);
      gl.uniform3f(places.shift, ...body.shift);
      for (let n = body.first; n < body.first + body.shown; n++) {
        gl.uniformMatrix3fv(places.turn, false, turned(body, angle + ((n + body.turn) * 2 * Math.PI) / body.teeth));
        gl.drawElements(gl.TRIANGLES, body.tooth.count, gl.UNSIGNED_INT, 0);
      }
    }

    // nearest surface only, blended over what is there
    function drawClear(body, angle) {
      gl.colorMask(false, false, false, false);
      drawBody(body, angle, 1);
      gl.colorMask(true, true, true, true);
      gl.depthFunc(gl.LEQUAL);
      gl.enable(gl.BLEND);
      drawBody(body, angle, 0.3);
      gl.disable(gl.BLEND);
    }

    function paint(drawn, turn) {
      gl.bindVertexArray(drawn.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, drawn.buffer);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, drawn.values);
      gl.uniformMatrix3fv(places.turn, false, turn);
      gl.drawElements(gl.TRIANGLES, drawn.count, gl.UNSIGNED_INT, 0);
    }

    function drawLoads(found, index, angle) {
      gl.uniform3f(places.shift, ...pinion.shift);
      const values = found.values[quantity().key];
      for (let tooth = -2; tooth <= 2; tooth++) {
        flank.values.fill(0);
        let any = false;
        for (let k = found.start[index]; k < found.start[index + 1]; k++)
          if (found.tooth[k] === tooth) {
            any = true;
            for (const node of [found.node[k] - columns, found.node[k], found.node[k] + columns])
              if (node >= 0 && node < nodes) {
                flank.values.set([values[k] / 255, 1, values[k] > 0 ? 1 : 0], 3 * node);
              }
          }
        if (any) paint(flank, turned(pinion, angle + ((tooth - 0.5) * 2 * Math.PI) / pinion.teeth));
      }
    }

    // a tooth's stress at a position of the pitch is that of its passage so many pitches on
    function drawRootStress(found, index, bodies) {
      for (const [body, angle] of bodies) {
        gl.uniform3f(places.shift, ...body.shift);
        const { drawn, first } = body.fillets, values = found.tension[body.name], gauges = drawn.values.length / 3;
        const last = first + values.length / gauges / data.positions.length;
        for (let tooth = Math.max(first, body.first); tooth < Math.min(last, body.first + body.shown); tooth++) {
          const row = ((tooth - first) * data.positions.length + index) * gauges;
          for (let k = 0; k < gauges; k++)
            drawn.values.set([values[row + k] / 255, 1, values[row + k] > 0 ? 1 : 0], 3 * k);
          paint(drawn, turned(body, angle + ((tooth + body.turn) * 2 * Math.PI) / body.teeth));
        }
      }
    }

    function draw() {
      pending = false;
      cleared(gl, canvas);
      const index = +find("position").value, found = data.torques[+find("torque").value];
      const position = data.positions[index], clear = find("clear").value;
      const phi1 = ((position - 0.5) * 2 * Math.PI) / pinion.teeth, phi2 = (phi1 * pinion.teeth) / gear.teeth;
      const { matrix, back } = cameraMatrix(view, data.centre, data.size, canvas.width / canvas.height);
      gl.depthFunc(gl.LEQUAL);
      gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ONE, gl.ONE);
      gl.uniformMatrix4fv(places.camera, false, matrix);
      gl.uniform3f(places.eye, ...back);
      gl.uniform1i(places.painted, 0);
      const bodies = [[pinion, phi1], [gear, phi2]];
      const solid = bodies.filter(([body]) => clear !== body.name && clear !== "both");
      const glass = bodies.filter((entry) => !solid.includes(entry));
      for (const [body, angle] of solid) drawBody(body, angle, 1);
      for (const [body, angle] of glass) {
        drawClear(body, angle);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        gl.colorMask(false, false, false, false);
        for (const [other, turn] of solid) drawBody(other, turn, 1);
        gl.colorMask(true, true, true, true);
      }
      gl.uniform1i(places.painted, 1);
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(-8, -16);
      if (quantity().key === "root_stress") drawRootStress(found, index, bodies);
      else drawLoads(found, index, phi1);
      gl.disable(gl.POLYGON_OFFSET_FILL);
      gl.uniform1i(places.painted, 0);
      tell(found, index, position);
    }

    function tell(found, index, position) {
      const share = found.share[index].map((part, k) => [k - 2, part]).filter(([, part]) => part > 0.0005);
      const pairs = share.map(([pair, part]) => `pair ${pair}: ${(100 * part).toFixed(0)} %`).join(", ");
      root.querySelector("output").textContent =
        `Position ${position.toFixed(3)} of a pitch. ${pairs}. Transmission error ${found.error_um[index].toFixed(2)} µm.`;
      root.querySelector(".most").textContent = `${found.largest[quantity().key].toFixed(0)} ${quantity().unit}`;
      root.querySelector("p.quantity").textContent = quantity().help;
    }

    function redraw() {
      if (!pending) { pending = true; requestAnimationFrame(draw); }
    }

    steered(canvas, find, view, home, redraw);
    for (const name of ["position", "torque", "quantity", "clear"]) find(name).addEventListener("input", redraw);
    find("turn").addEventListener("click", (event) => {
      clearInterval(moving);
      moving = moving ? 0 : setInterval(() => {
        find("position").value = (+find("position").value + 1) % data.positions.length;
        redraw();
      }, 120);
      event.target.textContent = moving ? "Stop" : "Turn";
    });
    redraw();
  }

  watch("pair", start);
})();
