// The scene: capsules and boxes on a ground grid, drawn with WebGL. World: metres, z up. Matrices are column-major.

const Matrix = {
  multiply(a, b) {
    const out = new Float32Array(16);
    for (let column = 0; column < 4; column++) {
      for (let row = 0; row < 4; row++) {
        let sum = 0;
        for (let k = 0; k < 4; k++) sum += a[4 * k + row] * b[4 * column + k];
        out[4 * column + row] = sum;
      }
    }
    return out;
  },
  perspective(fieldOfView, aspect, near, far) {
    const f = 1 / Math.tan(fieldOfView / 2);
    return new Float32Array([
      f / aspect, 0, 0, 0,
      0, f, 0, 0,
      0, 0, (far + near) / (near - far), -1,
      0, 0, 2 * far * near / (near - far), 0,
    ]);
  },
  lookAt(eye, target) {
    const z = Vector.unit(Vector.minus(eye, target));
    const x = Vector.unit(Vector.cross([0, 0, 1], z));
    const y = Vector.cross(z, x);
    return new Float32Array([
      x[0], y[0], z[0], 0,
      x[1], y[1], z[1], 0,
      x[2], y[2], z[2], 0,
      -Vector.dot(x, eye), -Vector.dot(y, eye), -Vector.dot(z, eye), 1,
    ]);
  },
  // Of a position and a quaternion w x y z.
  pose(p, [w, x, y, z]) {
    return new Float32Array([
      1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
      2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
      2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0,
      p[0], p[1], p[2], 1,
    ]);
  },
  columns(x, y, z, origin) {
    return new Float32Array([...x, 0, ...y, 0, ...z, 0, ...origin, 1]);
  },
};

const Vector = {
  minus: (a, b) => a.map((x, i) => x - b[i]),
  scale: (a, k) => a.map((x) => x * k),
  dot: (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0),
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  unit: (a) => Vector.scale(a, 1 / Math.hypot(...a)),
};

// Triangles with normals: unit ball, unit tube from z = 0 to 1, box from -1 to 1, ground square.
const Mesh = {
  // Surface of revolution about z from a profile of [radius, z, normal radius, normal z].
  turned(profile) {
    const out = [], around = 20;
    const point = ([r, z, nr, nz], i) => {
      const angle = 2 * Math.PI * i / around, c = Math.cos(angle), s = Math.sin(angle);
      return [r * c, r * s, z, nr * c, nr * s, nz];
    };
    for (let j = 0; j + 1 < profile.length; j++) {
      for (let i = 0; i < around; i++) {
        const [a, b] = [profile[j], profile[j + 1]];
        const corners = [point(a, i), point(a, i + 1), point(b, i), point(b, i + 1)];
        out.push(...corners[0], ...corners[1], ...corners[2], ...corners[2], ...corners[1], ...corners[3]);
      }
    }
    return out;
  },
  ball() {
    const profile = [], rings = 12;
    for (let j = 0; j <= rings; j++) {
      const angle = Math.PI * (j / rings - 0.5), r = Math.cos(angle), z = Math.sin(angle);
      profile.push([r, z, r, z]);
    }
    return Mesh.turned(profile);
  },
  tube: () => Mesh.turned([[1, 0, 1, 0], [1, 1, 1, 0]]),
  box() {
    const out = [];
    for (let axis = 0; axis < 3; axis++) {
      for (const side of [-1, 1]) {
        const corner = (u, v) => {
          const p = [0, 0, 0], n = [0, 0, 0];
          p[axis] = side; p[(axis + 1) % 3] = u; p[(axis + 2) % 3] = v;
          n[axis] = side;
          return [...p, ...n];
        };
        for (const [u, v] of [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]]) out.push(...corner(u, v));
      }
    }
    return out;
  },
  ground: () => [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]].flatMap(([x, y]) => [x, y, 0, 0, 0, 1]),
};

const VERTEX = `
attribute vec3 position; attribute vec3 normal;
uniform mat4 model, camera;
varying vec3 place, facing;
void main() {
  vec4 world = model * vec4(position, 1.0);
  place = world.xyz;
  facing = mat3(model[0].xyz, model[1].xyz, model[2].xyz) * normal;
  gl_Position = camera * world;
}`;

// kind 0: a lit solid; 1: the ground with its grid; 2: a shadow.
const FRAGMENT = `
precision highp float;
uniform vec3 colour, eye, centre, sky;
uniform int kind;
varying vec3 place, facing;
float line(float spacing, float width, float distance) {
  vec2 off = abs(fract(place.xy / spacing + 0.5) - 0.5) * spacing;
  float w = width * (0.6 + 0.3 * distance);
  return 1.0 - smoothstep(w, 2.0 * w, min(off.x, off.y));
}
void main() {
  float away = distance(place, eye);
  if (kind == 1) {
    vec3 ground = mix(vec3(0.87, 0.89, 0.91), vec3(0.72, 0.76, 0.80), 0.5 * line(0.25, 0.002, away));
    ground = mix(ground, vec3(0.55, 0.61, 0.67), line(1.0, 0.003, away));
    gl_FragColor = vec4(mix(ground, sky, smoothstep(4.0, 11.0, distance(place.xy, centre.xy))), 1.0);
  } else if (kind == 2) {
    gl_FragColor = vec4(0.62, 0.65, 0.69, 1.0);
  } else {
    vec3 n = normalize(facing);
    float key = max(0.0, dot(n, normalize(vec3(0.35, -0.5, 0.9))));
    float fill = max(0.0, dot(n, normalize(vec3(-0.6, 0.6, 0.1))));
    gl_FragColor = vec4(colour * (0.50 + 0.52 * key + 0.22 * fill), 1.0);
  }
}`;

// Where a pixel below z = 0 could be: shadows lie on the ground, thrown by a light from above.
const SHADOW = new Float32Array([1, 0, 0, 0, 0, 1, 0, 0, -0.25, 0.35, 0, 0, 0, 0, 0.002, 1]);
const SKY = [0.933, 0.945, 0.957];

class Scene {
  // Throws when the browser gives no WebGL.
  constructor(canvas, bodies) {
    // The drawing is kept so that a picture of the page shows it.
    const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("This browser gives no WebGL; the traces below still work.");
    this.canvas = canvas;
    this.gl = gl;
    this.program = this.build();
    this.meshes = Object.fromEntries(
      ["ball", "tube", "box", "ground"].map((name) => [name, this.load(Mesh[name]())]));
    this.pieces = bodies.map((shapes) => shapes.flatMap(pieces));
    this.view = { azimuth: -1.0, elevation: 0.16, distance: 2.5 };
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(...SKY, 1);
  }

  build() {
    const gl = this.gl, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "position");
    gl.bindAttribLocation(program, 1, "normal");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    gl.useProgram(program);
    gl.enableVertexAttribArray(0);
    gl.enableVertexAttribArray(1);
    this.at = (name) => gl.getUniformLocation(program, name);
    this.places = Object.fromEntries(
      ["model", "camera", "colour", "eye", "centre", "sky", "kind"].map((name) => [name, this.at(name)]));
    return program;
  }

  load(numbers) {
    const gl = this.gl, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
    return { buffer, count: numbers.length / 6 };
  }

  draw(mesh, model) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.buffer);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 24, 0);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 24, 12);
    gl.uniformMatrix4fv(this.places.model, false, model);
    gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
  }

  // poses: a matrix per body; colours: one per body; target: what the camera looks at.
  render(poses, colours, target) {
    const { gl, canvas, places, view } = this;
    const density = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(canvas.clientWidth * density));
    const height = Math.max(1, Math.round(canvas.clientHeight * density));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const level = Math.cos(view.elevation) * view.distance;
    const eye = [
      target[0] + level * Math.cos(view.azimuth),
      target[1] + level * Math.sin(view.azimuth),
      Math.max(0.05, target[2] + Math.sin(view.elevation) * view.distance),
    ];
    const lens = Matrix.perspective(0.7, width / height, 0.05, 60);
    gl.uniformMatrix4fv(places.camera, false, Matrix.multiply(lens, Matrix.lookAt(eye, target)));
    gl.uniform3fv(places.eye, eye);
    gl.uniform3fv(places.centre, target);
    gl.uniform3fv(places.sky, SKY);
    gl.uniform1i(places.kind, 1);
    this.draw(this.meshes.ground, Matrix.columns([14, 0, 0], [0, 14, 0], [0, 0, 1], [target[0], target[1], 0]));
    gl.uniform1i(places.kind, 2);
    this.each(poses, (body, mesh, model) => this.draw(mesh, Matrix.multiply(SHADOW, model)));
    gl.uniform1i(places.kind, 0);
    this.each(poses, (body, mesh, model) => {
      gl.uniform3fv(places.colour, colours[body]);
      this.draw(mesh, model);
    });
  }

  each(poses, act) {
    this.pieces.forEach((list, body) => {
      for (const { mesh, local } of list) act(body, this.meshes[mesh], Matrix.multiply(poses[body], local));
    });
  }
}

// The meshes that make a shape, each with its matrix in the body's frame.
function pieces(shape) {
  if (shape.half) {
    const [x, y, z] = shape.half;
    return [{ mesh: "box", local: Matrix.columns([x, 0, 0], [0, y, 0], [0, 0, z], shape.centre) }];
  }
  const { from, to, radius: r } = shape;
  const ball = (centre) => ({ mesh: "ball", local: Matrix.columns([r, 0, 0], [0, r, 0], [0, 0, r], centre) });
  const along = Vector.minus(to, from), length = Math.hypot(...along);
  if (length < 1e-6) return [ball(from)];
  const z = Vector.scale(along, 1 / length);
  const x = Vector.unit(Vector.cross(Math.abs(z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], z));
  const y = Vector.cross(z, x);
  const tube = Matrix.columns(Vector.scale(x, r), Vector.scale(y, r), along, from);
  return [ball(from), { mesh: "tube", local: tube }, ball(to)];
}
