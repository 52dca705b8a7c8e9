// SPDX-License-Identifier: Apache-2.0
// Draws vehicles, and those around them, at a moment.
import {Theme, series_color} from './color';
import {Motion, Seen, Tracks, motion_at, plays} from './motion';
import {Position, Scene} from './types';

const kLeastLength = 16; // px of a vehicle, however far away
const kShownWay = 1;     // s of an agent's way that is drawn

export class Moving {
  private readonly tracks: Tracks|null;

  constructor(private readonly scene: Scene) {
    this.tracks = scene.agents ? new Tracks(scene.agents) : null;
  }

  /// In a context whose unit is the metre, counted from `origin`; `scale` is [px/m].
  paint(context: CanvasRenderingContext2D, origin: Position, scale: number, t: number, theme: Theme): void {
    for (const seen of this.tracks?.at(t) ?? []) paint_agent(context, seen, origin, scale, theme);
    this.scene.vehicles.forEach(({series, outline}, i) => {
      if (!plays(series)) return;
      const color = this.scene.vehicles.length > 1 ? series_color(i, theme) : theme.get('accent');
      const {front_m, rear_m, width_m} = outline ?? {front_m: 1, rear_m: 1, width_m: 1};
      paint_vehicle(context, motion_at(series, t), [front_m, rear_m, width_m], origin, scale, color, theme);
    });
  }
}

function paint_agent(context: CanvasRenderingContext2D, seen: Seen, origin: Position, scale: number, theme: Theme): void {
  const [x, y] = [seen.x - origin[0], seen.y - origin[1]];
  context.beginPath();
  context.arc(x, y, Math.max(seen.radius, 2 / scale), 0, 2 * Math.PI);
  context.fillStyle = theme.get('agent');
  context.fill();
  context.strokeStyle = theme.get('agent-edge');
  context.lineWidth = 1.2 / scale;
  context.stroke();
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x + kShownWay * seen.vx, y + kShownWay * seen.vy);
  context.stroke();
}

function paint_vehicle(context: CanvasRenderingContext2D, at: Motion, [front, rear, width]: [number, number, number],
                       origin: Position, scale: number, color: string, theme: Theme): void {
  context.save();
  context.translate(at.x - origin[0], at.y - origin[1]);
  context.rotate(at.yaw);
  const larger = Math.max(1, kLeastLength / ((front + rear) * scale));
  context.scale(larger, larger);
  const half = width / 2;
  context.beginPath();
  context.rect(-rear, -half, front + rear, width);
  context.fillStyle = color;
  context.fill();
  context.lineWidth = 1.5 / (scale * larger);
  context.strokeStyle = theme.get('card');
  context.stroke();
  // Where it heads for: a wedge from the middle to the front.
  const middle = (front - rear) / 2;
  context.beginPath();
  context.moveTo(front - 0.12 * width, 0);
  context.lineTo(middle, 0.7 * half);
  context.lineTo(middle, -0.7 * half);
  context.closePath();
  context.fillStyle = theme.get('card');
  context.fill();
  context.restore();
}
