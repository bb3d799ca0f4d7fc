// The interactive 3D view: surfaces and meshes cut open, with three.js.
"use strict";
const views = (() => {
  const kTetFaces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
  const kSeen = 1.5;  // radius around the origin that the camera below has in view
  let shared = null;  // one renderer for the view and for all pictures of the gallery

  function bytes(text) {
    const raw = atob(text), out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
    return out.buffer;
  }

  // Turns the texts of one part into arrays, once.
  function unpack(part) {
    if (part.vertices) return part;
    part.vertices = new Float32Array(bytes(part.v));
    part.cells = part.wide ? new Uint32Array(bytes(part.c)) : new Uint16Array(bytes(part.c));
    part.extent = part.vertices.reduce((most, x) => Math.max(most, Math.abs(x)), 1);
    part.radius = 1e-9;
    for (let i = 0; i < part.vertices.length; i += 3) {
      part.radius = Math.max(part.radius, Math.hypot(part.vertices[i], part.vertices[i + 1], part.vertices[i + 2]));
    }
    if (part.q) part.quality = new Uint8Array(bytes(part.q));
    if (part.i) part.inside = new Uint8Array(bytes(part.i));
    delete part.v, delete part.c, delete part.q, delete part.i;
    if (part.kind === "mesh") part.neighbours = neighbours(part);
    return part;
  }

  // For each face of each tetrahedron the tetrahedron on its other side, or -1.
  function neighbours(part) {
    const n = part.vertices.length / 3, cells = part.cells, found = new Int32Array(cells.length).fill(-1);
    const open = new Map();
    for (let t = 0; t < cells.length / 4; ++t) {
      for (let f = 0; f < 4; ++f) {
        const [a, b, c] = kTetFaces[f].map(k => cells[4 * t + k]).sort((x, y) => x - y);
        const key = (a * n + b) * n + c, other = open.get(key);
        if (other === undefined) {
          open.set(key, 4 * t + f);
        } else {
          found[4 * t + f] = other >> 2;
          found[other] = t;
          open.delete(key);
        }
      }
    }
    return found;
  }

  function keptTetrahedra(part, look) {
    const { cells, vertices, inside } = part, kept = new Uint8Array(cells.length / 4);
    // What is cut off is always on the side of the eye.
    const side = look.axis === 1 ? -1 : 1, cut = look.cut * part.extent;
    for (let t = 0; t < kept.length; ++t) {
      let at = 0;
      for (let k = 0; k < 4; ++k) at += vertices[3 * cells[4 * t + k] + look.axis] / 4;
      kept[t] = side * at <= cut && !(look.insideOnly && inside && !inside[t]) ? 1 : 0;
    }
    return kept;
  }

  // The faces to be seen: corners, and whether each belongs to a bad tetrahedron or to the cut.
  function visibleFaces(part, look) {
    const faces = [], kinds = [];
    if (part.kind !== "mesh") {
      for (let t = 0; t < part.cells.length; t += 3) {
        faces.push(part.cells[t], part.cells[t + 1], part.cells[t + 2]);
        kinds.push(0);
      }
      return { faces, kinds, bad: 0 };
    }
    const kept = keptTetrahedra(part, look);
    let bad = 0;
    for (let t = 0; t < kept.length; ++t) {
      if (!kept[t]) continue;
      const isBad = part.quality[t] < 4 * look.bad;
      bad += isBad;
      for (let f = 0; f < 4; ++f) {
        const other = part.neighbours[4 * t + f];
        if (other >= 0 && kept[other]) continue;
        for (const k of kTetFaces[f]) faces.push(part.cells[4 * t + k]);
        kinds.push(isBad ? 2 : other >= 0 ? 1 : 0);
      }
    }
    return { faces, kinds, bad };
  }

  const kColours = [[0.62, 0.70, 0.80], [0.93, 0.80, 0.48], [0.84, 0.10, 0.12]];

  function object(part, look) {
    const seen = visibleFaces(unpack(part), look);
    const position = new Float32Array(3 * seen.faces.length), colour = new Float32Array(3 * seen.faces.length);
    const edges = new Float32Array(6 * seen.faces.length);
    seen.faces.forEach((v, i) => {
      const next = seen.faces[i % 3 === 2 ? i - 2 : i + 1];
      for (let k = 0; k < 3; ++k) {
        position[3 * i + k] = part.vertices[3 * v + k];
        colour[3 * i + k] = kColours[seen.kinds[Math.floor(i / 3)]][k];
        edges[6 * i + k] = part.vertices[3 * v + k];
        edges[6 * i + 3 + k] = part.vertices[3 * next + k];
      }
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colour, 3));
    geometry.computeVertexNormals();
    const group = new THREE.Group();
    group.add(new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 })));
    if (look.edges) {
      const lines = new THREE.BufferGeometry();
      lines.setAttribute("position", new THREE.BufferAttribute(edges, 3));
      group.add(new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: 0x202830, transparent: true, opacity: 0.45 })));
    }
    group.scale.setScalar(kSeen / part.radius);
    group.userData = { bad: seen.bad, faces: seen.faces.length / 3 };
    return group;
  }

  function scene() {
    const s = new THREE.Scene();
    s.add(new THREE.AmbientLight(0xffffff, 0.55));
    for (const [x, y, z, strength] of [[1.5, -3, 4, 0.55], [-3, 2, -1, 0.3], [4, -1, 1, 0.2]]) {
      const light = new THREE.DirectionalLight(0xffffff, strength);
      light.position.set(x, y, z);
      s.add(light);
    }
    return s;
  }

  function renderer() {
    if (shared === null) {
      shared = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    }
    return shared;
  }

  function camera(aspect) {
    const c = new THREE.PerspectiveCamera(32, aspect, 0.05, 50);
    c.up.set(0, 0, 1);
    c.position.set(3.2, -3.8, 2.4);
    c.lookAt(0, 0, 0);
    return c;
  }

  const kPlain = { axis: 1, cut: 1e9,  // all of it
                   bad: 0, insideOnly: false, edges: true };

  function free(group) {
    group.traverse(o => { if (o.geometry) { o.geometry.dispose(); o.material.dispose(); } });
  }

  // A still picture of a part, on a canvas of the gallery. Pictures share one renderer. Returns whether
  // it is cut as asked.
  function picture(canvas, part, look) {
    const size = 2 * Math.max(80, canvas.clientWidth);
    canvas.width = canvas.height = size;
    const r = stills(), s = scene();
    // A mesh of a few tetrahedra may lie on the side of the eye: then it is shown whole.
    let group = object(part, { ...kPlain, ...look });
    const cut = group.userData.faces > 0;
    if (!cut) group = object(part, { ...kPlain, ...look, cut: kPlain.cut, insideOnly: false });
    s.add(group);
    r.setSize(size, size, false);
    r.render(s, camera(1));
    canvas.getContext("2d").drawImage(r.domElement, 0, 0);
    free(group);
    return cut;
  }
  let stillRenderer = null;
  function stills() {
    if (stillRenderer === null) {
      stillRenderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    }
    return stillRenderer;
  }

  // The interactive view in an element of class "view".
  function open(element) {
    const r = renderer(), s = scene(), said = document.createElement("div");
    said.className = "said";
    element.replaceChildren(r.domElement, said);
    const eye = camera(1), controls = new THREE.OrbitControls(eye, r.domElement);
    let group = null;
    const render = () => r.render(s, eye);
    controls.addEventListener("change", render);
    function resize() {
      const width = element.clientWidth, height = element.clientHeight;
      if (width === 0) return;
      r.setPixelRatio(Math.min(2, devicePixelRatio));
      r.setSize(width, height);
      eye.aspect = width / height;
      eye.updateProjectionMatrix();
      render();
    }
    new ResizeObserver(resize).observe(element);
    function show(part, look, model) {
      if (group !== null) {
        s.remove(group);
        free(group);
      }
      group = object(part, { ...kPlain, ...look });
      s.add(group);
      resize();
      const whose = `${model}, ${part.label}: `;
      said.textContent = whose + (part.kind === "mesh"
        ? `${part.cells.length / 4} tetrahedra; ${group.userData.bad} shown with a face angle below ${look.bad} degrees (red)`
        : `${part.cells.length / 3} triangles`);
    }
    return { show, element };
  }

  return { open, picture };
})();
