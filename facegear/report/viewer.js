// What the viewers of the report share: their start, packed arrays, surfaces, a camera, steering by pointer and buttons.
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

// context, data, elements by name and uniforms of a viewer; null where the browser cannot draw it, which the page then says
async function opened(root, vertex, fragment, attributes, uniforms) {
  const canvas = root.querySelector("canvas");
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl || !window.DecompressionStream) { root.querySelector("p.missing").hidden = false; return null; }
  const data = JSON.parse(await unpacked(root.querySelector("script")));
  const find = (name) => root.querySelector(`[name=${name}]`);
  const program = linked(gl, vertex, fragment, attributes);
  gl.useProgram(program);
  const places = Object.fromEntries(uniforms.map((name) => [name, gl.getUniformLocation(program, name)]));
  gl.uniform3fv(places.scale, parsed(data.colours));
  return { canvas, gl, data, find, places };
}

// triangles between points, three numbers each; they stay bound
function surface(gl, points, indices) {
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, points, gl.STATIC_DRAW);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint32Array(indices), gl.STATIC_DRAW);
  return { array, count: indices.length };
}

// buffer of three numbers a point of the bound surface, zero at first, that change from picture to picture
function changing(gl, count) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, 12 * count, gl.DYNAMIC_DRAW);
  gl.enableVertexAttribArray(1);
  gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 0);
  return buffer;
}

// an empty picture as fine as the screen, up to twice the page's pixels
function cleared(gl, canvas) {
  const dense = Math.min(window.devicePixelRatio || 1, 2);
  canvas.width = Math.round(canvas.clientWidth * dense);
  canvas.height = Math.round(canvas.clientHeight * dense);
  gl.viewport(0, 0, canvas.width, canvas.height);
  gl.clearColor(...(matchMedia("(prefers-color-scheme: dark)").matches ? [0.08, 0.1, 0.12] : [1, 1, 1]), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
}

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
