// The surface with its defects, and the mesh cut open. three.js is a global.
const kStops = [[0, [0.75, 0.1, 0.12]], [10, [0.96, 0.49, 0.15]], [25, [0.99, 0.84, 0.35]], [40, [0.55, 0.82, 0.55]], [60, [0.1, 0.53, 0.65]]];
const kMostLines = 400000;

/** The colour of a smallest dihedral angle in degrees, as in the pictures of the documentation. */
function colour_of(angle) {
  let n = 1;
  while (n + 1 < kStops.length && angle > kStops[n][0]) ++n;
  const [low, from] = kStops[n - 1], [high, to] = kStops[n], share = Math.min(1, Math.max(0, (angle - low) / (high - low)));
  return from.map((channel, k) => channel + share * (to[k] - channel));
}

export function draw_legend(colours, degrees) {
  const last = kStops[kStops.length - 1][0], css = ([r, g, b]) => `rgb(${[r, g, b].map((c) => Math.round(255 * c)).join(" ")})`;
  colours.style.background = `linear-gradient(to right, ${kStops.map(([angle, c]) => `${css(c)} ${(100 * angle) / last}%`).join(", ")})`;
  for (const [angle] of kStops) {
    const tick = document.createElement("span");
    tick.textContent = `${angle}°`;
    tick.style.left = `${(100 * angle) / last}%`;
    degrees.append(tick);
  }
}

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const kFaces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];  // outwards, opposite to each corner

function smallest_angle(corners) {
  const normals = kFaces.map(([a, b, c]) => cross(minus(corners[b], corners[a]), minus(corners[c], corners[a])));
  let most = -1;
  for (let i = 0; i < 4; ++i) {
    for (let j = 0; j < i; ++j) {
      most = Math.max(most, -dot(normals[i], normals[j]) / Math.sqrt(dot(normals[i], normals[i]) * dot(normals[j], normals[j])));
    }
  }
  return (Math.acos(Math.min(1, Math.max(-1, most))) * 180) / Math.PI;
}

/** For each face of each tetrahedron the one behind it; -1 outside. */
function neighbours_of(tetrahedra) {
  const count = tetrahedra.length, behind = new Int32Array(count).fill(-1);
  let size = 1;
  while (size < 2 * count) size *= 2;
  const slots = new Int32Array(size).fill(-1), corners = new Uint32Array(3 * count);
  for (let face = 0; face < count; ++face) {
    const base = face & ~3;
    const [a, b, c] = kFaces[face & 3].map((k) => tetrahedra[base + k]).sort((x, y) => x - y);
    corners.set([a, b, c], 3 * face);
    let slot = (Math.imul(a, 73856093) ^ Math.imul(b, 19349663) ^ Math.imul(c, 83492791)) & (size - 1);
    for (; slots[slot] >= 0; slot = (slot + 1) & (size - 1)) {
      const other = slots[slot];
      if (corners[3 * other] !== a || corners[3 * other + 1] !== b || corners[3 * other + 2] !== c) continue;
      behind[face] = other >> 2;
      behind[other] = face >> 2;
      break;
    }
    if (slots[slot] < 0) slots[slot] = face;
  }
  return behind;
}

export class View {
  constructor(frame) {
    this.frame = frame;
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    frame.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.001, 100);
    this.camera.up.set(0, 0, 1);
    const light = new THREE.DirectionalLight(0xffffff, 0.6);
    light.position.set(0.3, 0.5, 1);
    this.camera.add(light);
    this.scene.add(this.camera, new THREE.AmbientLight(0xffffff, 0.42));
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.draw());
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.show_again?.());
    new ResizeObserver(() => this.resize()).observe(frame);
    this.shown = [];
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.frame;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
  draw() {
    this.renderer.render(this.scene, this.camera);
  }

  // All is shown with its box's middle at the origin and a diagonal of 1: single precision is enough then.
  fit(points) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let n = 0; n < points.length; ++n) {
      if (!Number.isFinite(points[n])) continue;
      low[n % 3] = Math.min(low[n % 3], points[n]);
      high[n % 3] = Math.max(high[n % 3], points[n]);
    }
    this.middle = low.map((x, k) => (Number.isFinite(x) ? (x + high[k]) / 2 : 0));
    this.scale = 1 / (Math.hypot(...minus(high, low)) || 1);
    this.low = this.place(low);
    this.high = this.place(high);
  }
  place(p) {
    return [0, 1, 2].map((k) => (p[k] - this.middle[k]) * this.scale);
  }
  corner(points, vertex) {
    return this.place([points[3 * vertex], points[3 * vertex + 1], points[3 * vertex + 2]]);
  }

  look_at(target, distance, direction) {
    const length = Math.hypot(...direction);
    this.controls.target.set(...target);
    this.camera.position.set(...target.map((x, k) => x + (distance * direction[k]) / length));
    this.controls.update();
    this.draw();
  }
  look_at_all() {
    this.resize();
    this.look_at([0, 0, 0], 1.4 / Math.min(1, this.camera.aspect), [1, 0.75, 0.6]);
  }
  /** Goes to a place of the file, and looks at it from outside. */
  go_to(point) {
    const target = this.place(point);
    this.look_at(target, 0.45, Math.hypot(...target) > 0.05 ? target : [1, 0.75, 0.6]);
  }

  show(...objects) {
    for (const old of this.shown) {
      this.scene.remove(old);
      old.geometry.dispose();
      old.material.dispose();
    }
    this.shown = objects;
    this.scene.add(...objects);
    this.draw();
  }
  faces(positions, colours) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    geometry.computeVertexNormals();
    return new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    }));
  }
  edges(positions) {
    const count = positions.length / 9, lines = new Float32Array(count > kMostLines ? 0 : 18 * count);
    for (let t = 0; 18 * t < lines.length; ++t) {
      [0, 1, 1, 2, 2, 0].forEach((k, n) => lines.set(positions.subarray(9 * t + 3 * k, 9 * t + 3 * k + 3), 18 * t + 3 * n));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(lines, 3));
    return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: 0x10141a, transparent: true, opacity: this.dark.matches ? 0.6 : 0.3 }));
  }

  /** The surface of `check --defects`; colours(kind) of a triangle or an edge; `spots` are marked. */
  show_surface(vtu, colours, spots, stay = false) {
    const { points, cells, arrays } = vtu, grey = [0.72, 0.76, 0.8];
    if (!stay) this.fit(points);
    const triangles = cells[3].length / 3, positions = new Float32Array(9 * triangles), shades = new Float32Array(9 * triangles);
    for (let t = 0; t < triangles; ++t) {
      const colour = colours(Number(arrays.defect[t])) ?? grey;
      for (let k = 0; k < 3; ++k) {
        positions.set(this.corner(points, Number(cells[3][3 * t + k])), 9 * t + 3 * k);
        shades.set(colour, 9 * t + 3 * k);
      }
    }
    const wrong = new Float32Array(3 * cells[2].length), wrong_shades = new Float32Array(3 * cells[2].length);
    cells[2].forEach((vertex, n) => {
      wrong.set(this.corner(points, Number(vertex)), 3 * n);
      wrong_shades.set(colours(Number(arrays.defect[triangles + (n >> 1)])) ?? grey, 3 * n);
    });
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.BufferAttribute(wrong, 3));
    lines.setAttribute("color", new THREE.BufferAttribute(wrong_shades, 3));
    const marks = new THREE.BufferGeometry();
    marks.setAttribute("position", new THREE.BufferAttribute(new Float32Array(spots.flatMap((p) => this.place(p))), 3));
    this.show(this.faces(positions, shades), this.edges(positions), new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ vertexColors: THREE.VertexColors, depthTest: false })),
      new THREE.Points(marks, new THREE.PointsMaterial({ color: 0xe02020, size: 7, sizeAttenuation: false, depthTest: false })));
    if (!stay) this.look_at_all();
    this.show_again = () => this.show_surface(vtu, colours, spots, true);
  }

  take_mesh(vtu) {
    this.fit(vtu.points);
    const tetrahedra = Uint32Array.from(vtu.cells[4], Number), count = tetrahedra.length / 4;
    this.mesh = {
      tetrahedra,
      places: new Float32Array(vtu.points.length),
      behind: neighbours_of(tetrahedra),
      colours: new Float32Array(3 * count),
      centres: new Float32Array(3 * count),
    };
    const { places, colours, centres } = this.mesh;
    for (let v = 0; v < places.length / 3; ++v) places.set(this.corner(vtu.points, v), 3 * v);
    for (let t = 0; t < count; ++t) {
      const corners = [0, 1, 2, 3].map((k) => this.corner(vtu.points, tetrahedra[4 * t + k]));
      colours.set(colour_of(smallest_angle(corners)), 3 * t);
      centres.set([0, 1, 2].map((k) => corners.reduce((sum, p) => sum + p[k], 0) / 4), 3 * t);
    }
    this.look_at_all();
  }
  /** Leaves out the tetrahedra beyond a share of the box along an axis; what is cut open shows their quality. */
  cut_mesh(axis, share) {
    const { tetrahedra, places, behind, colours, centres } = this.mesh, count = tetrahedra.length / 4;
    const limit = this.low[axis] + share * (this.high[axis] - this.low[axis]) + (share >= 1 ? 1 : 0);
    const kept = (t) => centres[3 * t + axis] <= limit;
    const faces = [];
    for (let face = 0; face < 4 * count; ++face) {
      if (kept(face >> 2) && (behind[face] < 0 || !kept(behind[face]))) faces.push(face);
    }
    const positions = new Float32Array(9 * faces.length), shades = new Float32Array(9 * faces.length), grey = [0.72, 0.76, 0.8];
    faces.forEach((face, n) => {
      const inside = behind[face] >= 0, t = face >> 2;
      kFaces[face & 3].forEach((k, c) => {
        const vertex = tetrahedra[4 * t + k];
        for (let d = 0; d < 3; ++d) {
          positions[9 * n + 3 * c + d] = places[3 * vertex + d];
          shades[9 * n + 3 * c + d] = inside ? colours[3 * t + d] : grey[d];
        }
      });
    });
    this.show(this.faces(positions, shades), this.edges(positions));
    this.show_again = () => this.cut_mesh(axis, share);
  }
}
