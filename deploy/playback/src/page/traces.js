// The traces: what was asked for and what was done, over the time of the recording.

class Traces {
  constructor(canvas, data) {
    this.canvas = canvas;
    const pick = (rows, index, width) => Array.from({ length: data.count }, (_, i) => rows[i * width + index]);
    const pair = (title, unit, index) => ({
      title, unit,
      lines: [
        { label: "asked", colour: "#9aa4b0", dash: [5, 4], values: pick(data.command, index, 3) },
        { label: "done", colour: "#24507f", dash: [], values: pick(data.velocity, index, 3) },
      ],
    });
    this.charts = [pair("forward", "m/s", 0), pair("yaw rate", "rad/s", 2)];
    if (data.forces) {
      this.charts.push({
        title: "foot force", unit: "N",
        lines: [
          { label: "left", colour: "#c9612c", dash: [], values: pick(data.forces, 0, 2) },
          { label: "right", colour: "#3d8f6a", dash: [], values: pick(data.forces, 1, 2) },
        ],
      });
    }
    this.count = data.count;
    this.frameSeconds = data.frameSeconds;
  }

  // The frame under a place of the page, and nothing outside the charts.
  frameAt(event) {
    const box = this.canvas.getBoundingClientRect();
    const gap = 18, width = (box.width - gap * (this.charts.length - 1)) / this.charts.length;
    const x = (event.clientX - box.left) % (width + gap);
    return Math.round(Math.min(1, Math.max(0, x / width)) * (this.count - 1));
  }

  render(frame) {
    const { canvas, charts } = this, density = window.devicePixelRatio || 1;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    canvas.width = Math.round(width * density);
    canvas.height = Math.round(height * density);
    const pen = canvas.getContext("2d");
    pen.scale(density, density);
    pen.clearRect(0, 0, width, height);
    const gap = 18, each = (width - gap * (charts.length - 1)) / charts.length;
    charts.forEach((chart, i) => this.chart(pen, chart, i * (each + gap), each, height, frame));
  }

  chart(pen, chart, left, width, height, frame) {
    const top = 20, bottom = height - 6;
    const values = chart.lines.flatMap((line) => line.values).filter(Number.isFinite);
    let [least, most] = [Math.min(0, ...values), Math.max(0.1, ...values)];
    const margin = 0.06 * (most - least);
    [least, most] = [least - margin, most + margin];
    const x = (i) => left + width * (this.count > 1 ? i / (this.count - 1) : 0);
    const y = (v) => bottom - (bottom - top) * (v - least) / (most - least);
    pen.fillStyle = "#f5f7f9";
    pen.fillRect(left, top, width, bottom - top);
    pen.strokeStyle = "#d5dbe2";
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(left, y(0));
    pen.lineTo(left + width, y(0));
    pen.stroke();
    pen.font = "12px system-ui, sans-serif";
    let at = left;
    const say = (text, colour) => {
      pen.fillStyle = colour;
      pen.fillText(text, at, 13);
      at += pen.measureText(text).width + 10;
    };
    say(`${chart.title}, ${chart.unit}`, "#1d2530");
    for (const line of chart.lines) {
      const now = line.values[frame];
      say(`${line.label} ${Math.abs(now) >= 100 ? now.toFixed(0) : now.toFixed(2)}`, line.colour);
      pen.strokeStyle = line.colour;
      pen.lineWidth = 1.4;
      pen.setLineDash(line.dash);
      pen.beginPath();
      line.values.forEach((value, i) => (i ? pen.lineTo(x(i), y(value)) : pen.moveTo(x(i), y(value))));
      pen.stroke();
      pen.setLineDash([]);
    }
    pen.fillStyle = "#8a94a1";
    pen.font = "10px system-ui, sans-serif";
    for (const value of [least + margin, most - margin]) {
      pen.fillText(Math.abs(value) >= 100 ? value.toFixed(0) : value.toFixed(2), left + 3, y(value) + 3);
    }
    const end = `${((this.count - 1) * this.frameSeconds).toFixed(1)} s`;
    pen.fillText(end, left + width - pen.measureText(end).width - 3, bottom - 3);
    pen.strokeStyle = "#c9433a";
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(x(frame), top);
    pen.lineTo(x(frame), bottom);
    pen.stroke();
  }
}
