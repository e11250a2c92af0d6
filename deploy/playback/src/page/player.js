// The player: time runs, the scene and the traces follow. `#t=1.5` in the address shows that moment, paused.

const element = (id) => document.getElementById(id);
const data = JSON.parse(element("recording").textContent);
const COLOURS = { body: [0.90, 0.92, 0.95], dark: [0.27, 0.30, 0.35], touching: [0.86, 0.45, 0.20] };
// A sole that carries less than this is taken to be in the air, N.
const TOUCH = 10;

let scene = null;
try {
  scene = new Scene(element("scene"), data.bodies);
} catch (problem) {
  element("trouble").hidden = false;
  element("trouble").textContent = problem.message;
}
const traces = new Traces(element("traces"), data);
const duration = (data.count - 1) * data.frameSeconds;
const player = { time: 0, playing: true, speed: 1, target: null };

function frameNow() {
  return Math.min(data.count - 1, Math.max(0, Math.round(player.time / data.frameSeconds)));
}

function poseOf(frame, body) {
  const at = frame * data.bodies.length + body;
  const numbers = (list, width) => list.slice(at * width, (at + 1) * width).map((x) => x / data.resolution);
  return Matrix.pose(numbers(data.positions, 3), numbers(data.rotations, 4));
}

function colourOf(frame, body) {
  const foot = data.feet.indexOf(body);
  if (foot < 0) return COLOURS.body;
  return data.forces && data.forces[2 * frame + foot] > TOUCH ? COLOURS.touching : COLOURS.dark;
}

function show() {
  const frame = frameNow();
  element("clock").textContent = `${player.time.toFixed(2)} s`;
  element("scrub").value = frame;
  element("play").textContent = player.playing ? "Pause" : "Play";
  document.body.dataset.frame = frame;
  document.body.dataset.playing = player.playing;
  traces.render(frame);
  if (!scene) return;
  const poses = data.bodies.map((_, body) => poseOf(frame, body));
  if (!player.target || element("follow").checked) player.target = [poses[0][12], poses[0][13], 0.62];
  scene.render(poses, data.bodies.map((_, body) => colourOf(frame, body)), player.target);
}

function seek(time) {
  player.time = Math.min(duration, Math.max(0, time));
  show();
}

function pause(paused) {
  player.playing = !paused;
  if (player.playing && player.time >= duration) player.time = 0;
  show();
}

let before = null;
function tick(now) {
  if (player.playing && before !== null) {
    player.time += (now - before) / 1000 * player.speed;
    if (player.time > duration) player.time %= duration;
    show();
  }
  before = now;
  requestAnimationFrame(tick);
}

element("scrub").max = data.count - 1;
element("scrub").addEventListener("input", (event) => {
  player.playing = false;
  seek(event.target.value * data.frameSeconds);
});
element("play").addEventListener("click", () => pause(player.playing));
element("speed").addEventListener("change", (event) => { player.speed = Number(event.target.value); });
element("follow").addEventListener("change", show);
element("traces").addEventListener("pointerdown", (event) => {
  player.playing = false;
  seek(traces.frameAt(event) * data.frameSeconds);
});
window.addEventListener("keydown", (event) => {
  const steps = { ArrowLeft: -1, ArrowRight: 1 };
  if (event.key === " ") pause(player.playing);
  else if (event.key in steps) {
    player.playing = false;
    seek((frameNow() + steps[event.key]) * data.frameSeconds);
  } else return;
  event.preventDefault();
});
window.addEventListener("resize", show);

if (scene) {
  const canvas = element("scene"), view = scene.view;
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (!canvas.hasPointerCapture(event.pointerId)) return;
    view.azimuth -= event.movementX * 0.008;
    view.elevation = Math.min(1.5, Math.max(-0.2, view.elevation + event.movementY * 0.008));
    show();
  });
  canvas.addEventListener("wheel", (event) => {
    view.distance = Math.min(15, Math.max(0.8, view.distance * Math.exp(event.deltaY * 0.001)));
    event.preventDefault();
    show();
  }, { passive: false });
}

const asked = /#t=([0-9.]+)/.exec(location.hash);
if (asked) player.playing = false;
seek(asked ? Number(asked[1]) : 0);
requestAnimationFrame(tick);
