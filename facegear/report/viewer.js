// What the viewers of the report share: packed arrays, a camera, steering by pointer and buttons.
"use strict";
const KINDS = { f: Float32Array, h: Int16Array, H: Uint16Array, b: Int8Array, B: Uint8Array };

function decoded(text, kind) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new KINDS[kind](bytes.buffer);
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// perspective looking along -back at the centre; columns first
function cameraMatrix(view, centre, size, aspect) {
  const [ca, sa, ce, se] = [Math.cos(view.azimuth), Math.sin(view.azimuth), Math.cos(view.height), Math.sin(view.height)];
  const back = [ce * ca, ce * sa, se], right = [-sa, ca, 0], up = cross(back, right);
  const focal = 3.2, distance = (focal * size * Math.max(0.62, 0.75 / aspect)) / view.zoom;
  const eye = centre.map((value, k) => value + distance * back[k]);
  const near = distance / 20, far = distance + 20 * size;
  const [p, q] = [-(far + near) / (far - near), (-2 * far * near) / (far - near)];
  const rows = [right.map((v) => (focal * v) / aspect), up.map((v) => focal * v), back];
  const moved = [-dot(rows[0], eye), -dot(rows[1], eye), -dot(back, eye)];
  const matrix = [];
  for (let k = 0; k < 3; k++) matrix.push(rows[0][k], rows[1][k], p * back[k], -back[k]);
  matrix.push(moved[0], moved[1], p * moved[2] + q, -moved[2]);
  return { matrix, back };
}

function linked(gl, vertex, fragment, attributes) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  attributes.forEach((name, place) => gl.bindAttribLocation(program, place, name));
  gl.linkProgram(program);
  return program;
}

const parsed = (colours) => colours.flatMap((colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16) / 255));

// a drag turns the view, buttons bring it nearer, further and home
function steered(canvas, find, view, home, redraw) {
  const held = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    view.azimuth -= (event.clientX - before[0]) / 150;
    view.height = Math.max(-1.5, Math.min(1.5, view.height + (event.clientY - before[1]) / 150));
    held.set(event.pointerId, [event.clientX, event.clientY]);
    redraw();
  });
  for (const name of ["pointerup", "pointercancel"])
    canvas.addEventListener(name, (event) => held.delete(event.pointerId));
  const zoomed = (factor) => () => { view.zoom = Math.max(0.4, Math.min(12, view.zoom * factor)); redraw(); };
  find("nearer").addEventListener("click", zoomed(1.35));
  find("further").addEventListener("click", zoomed(1 / 1.35));
  find("home").addEventListener("click", () => { Object.assign(view, home); redraw(); });
  new ResizeObserver(redraw).observe(canvas);
}

// starts the viewers of a kind, each not before it is near: a page opens without waiting for it
function watch(kind, start) {
  const watcher = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries)
      if (isIntersecting) { watcher.unobserve(target); start(target); }
  }, { rootMargin: "600px" });
  for (const root of document.querySelectorAll(".pair-view")) if (root.dataset.kind === kind) watcher.observe(root);
}
