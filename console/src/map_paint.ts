// SPDX-License-Identifier: Apache-2.0
// Draws the map's ground, its marks and its furniture (scale bar, north arrow, colour bar).
import {fixed, number} from './format';
import {Theme} from './color';
import {Layer, Mark, lines_of} from './layers';
import {Feature, Position} from './types';
import {round_length} from './view';

const kFont = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';

/// A font for canvases; size in px.
export function font(size: number, weight = 400): string {
  return `${weight} ${size}px ${kFont}`;
}

const kPointSize = 0.07; // of the points of a scan [m]

/// The outline of features in ground coordinates relative to `origin`.
export function make_path(features: Feature[], origin: Position): Path2D {
  const path = new Path2D();
  for (const feature of features) {
    if (feature.type === 'Point') continue;
    for (const line of lines_of(feature)) {
      if (feature.type === 'MultiPoint') {
        const [x, y] = line[0]!;
        path.rect(x - origin[0] - kPointSize / 2, y - origin[1] - kPointSize / 2, kPointSize, kPointSize);
        continue;
      }
      line.forEach(([x, y], i) => i ? path.lineTo(x - origin[0], y - origin[1])
                                    : path.moveTo(x - origin[0], y - origin[1]));
      if (feature.type === 'Polygon') path.closePath();
    }
  }
  return path;
}

/// Strokes and fills in a context whose unit is the metre; `scale` is [px/m].
export function paint_layer(context: CanvasRenderingContext2D, layer: Layer, path: Path2D, scale: number,
                            theme: Theme): void {
  if (layer.fill) {
    context.fillStyle = theme.get(layer.fill);
    context.fill(path, 'evenodd');
  }
  if (layer.stroke) {
    context.strokeStyle = theme.get(layer.stroke);
    context.lineWidth = (layer.width ?? 1) / scale;
    context.setLineDash((layer.dash ?? []).map((d) => d / scale));
    context.stroke(path);
    context.setLineDash([]);
  }
}

export function paint_mark(context: CanvasRenderingContext2D, mark: Mark, x: number, y: number, color: string,
                           halo: string): void {
  context.beginPath();
  if (mark === 'circle') context.arc(x, y, 5, 0, 2 * Math.PI);
  if (mark === 'square') context.rect(x - 4, y - 4, 8, 8);
  if (mark === 'diamond') [[0, -6], [6, 0], [0, 6], [-6, 0]].forEach(([dx, dy]) => context.lineTo(x + dx!, y + dy!));
  if (mark === 'bolt') context.arc(x, y, 8, 0, 2 * Math.PI);
  context.closePath();
  context.lineWidth = 3;
  context.strokeStyle = halo;
  context.stroke();
  context.fillStyle = color;
  context.fill();
  if (mark !== 'bolt') return;
  context.beginPath();
  [[1.5, -5.5], [-3.5, 1], [-0.5, 1], [-1.5, 5.5], [3.5, -1], [0.5, -1]].forEach(
      ([dx, dy]) => context.lineTo(x + dx!, y + dy!));
  context.fillStyle = halo;
  context.fill();
}

/// Names beside marks, leaving out those that would overlap.
export class Labels {
  private readonly taken: [number, number, number, number][] = [];
  constructor(private readonly context: CanvasRenderingContext2D, private readonly theme: Theme) {}

  write(text: string, x: number, y: number): void {
    this.context.font = font(11.5, 500);
    const width = this.context.measureText(text).width;
    const box: [number, number, number, number] = [x, y - 8, x + width, y + 8];
    if (this.taken.some((b) => box[0] < b[2] && b[0] < box[2] && box[1] < b[3] && b[1] < box[3])) return;
    this.taken.push(box);
    haloed(this.context, text, x, y, this.theme);
  }
}

function haloed(context: CanvasRenderingContext2D, text: string, x: number, y: number, theme: Theme): void {
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  context.lineWidth = 3.5;
  context.strokeStyle = theme.get('map-ground');
  context.strokeText(text, x, y);
  context.fillStyle = theme.get('text');
  context.fillText(text, x, y);
}

export function paint_scale_bar(context: CanvasRenderingContext2D, height: number, scale: number,
                                theme: Theme): void {
  const metres = round_length(110 / scale);
  const end = 16 + metres * scale;
  const y = height - 16;
  for (const [color, width] of [[theme.get('map-ground'), 5], [theme.get('text'), 1.6]] as const) {
    context.strokeStyle = color;
    context.lineWidth = width;
    context.lineCap = 'square';
    context.beginPath();
    context.moveTo(16, y - 5);
    context.lineTo(16, y);
    context.lineTo(end, y);
    context.lineTo(end, y - 5);
    context.stroke();
  }
  context.lineCap = 'butt';
  context.textAlign = 'left';
  context.font = font(11.5, 500);
  haloed(context, metres >= 1000 ? `${number(metres / 1000)} km` : `${number(metres)} m`, 22, y - 10, theme);
}

/// An arrow to the north of the map, or to where the vehicle of a scan heads.
export function paint_direction(context: CanvasRenderingContext2D, to: 'north'|'ahead', theme: Theme): void {
  const [x, y] = [26, 28];
  const outline = [[0, -13], [6, 5], [0, 1], [-6, 5]].map(([dx, dy]) => to === 'north' ? [dx!, dy!] : [-dy!, dx!]);
  context.fillStyle = theme.get('text');
  context.beginPath();
  outline.forEach(([dx, dy]) => context.lineTo(x + dx!, y + dy!));
  context.closePath();
  context.lineWidth = 3;
  context.strokeStyle = theme.get('map-ground');
  context.stroke();
  context.fill();
  context.textAlign = 'center';
  context.font = font(11, 600);
  haloed(context, to === 'north' ? 'N' : 'ahead', x, y + 14, theme);
  context.textAlign = 'left';
}

/// What colours mean, from low to high.
export interface ColorBar {
  title: string;
  short: string; // where there is little room
  color: (t: number) => string;
  low: string;
  high: string;
}

/// Bars beside each other, or where there is little room above each other; the right edge at `right`.
export function paint_color_bars(context: CanvasRenderingContext2D, right: number, height: number, bars: ColorBar[],
                                 theme: Theme): void {
  const narrow = right < 480;
  const width = narrow ? 84 : 120;
  bars.forEach((bar, i) => {
    const x = right - 16 - width - (narrow ? 0 : i * (width + 36));
    const y = height - 40 - (narrow ? i * 60 : 0);
    context.fillStyle = theme.get('map-panel');
    context.beginPath();
    context.rect(x - 12, y - 22, width + 24, 54);
    context.fill();
    const gradient = context.createLinearGradient(x, 0, x + width, 0);
    for (let k = 0; k <= 12; ++k) gradient.addColorStop(k / 12, bar.color(k / 12));
    context.fillStyle = gradient;
    context.fillRect(x, y, width, 8);
    context.fillStyle = theme.get('text');
    context.font = font(11, 500);
    context.textBaseline = 'alphabetic';
    context.textAlign = 'left';
    context.fillText(narrow ? bar.short : bar.title, x, y - 8);
    context.fillStyle = theme.get('muted');
    context.fillText(bar.low, x, y + 22);
    context.textAlign = 'right';
    context.fillText(bar.high, x + width, y + 22);
    context.textAlign = 'left';
  });
}

/// Where the cursor is.
export function paint_dot(context: CanvasRenderingContext2D, x: number, y: number, color: string, theme: Theme): void {
  context.beginPath();
  context.arc(x, y, 6.5, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.strokeStyle = theme.get('card');
  context.lineWidth = 2.5;
  context.fill();
  context.stroke();
}

export function coordinates_text(x: number, y: number, in_base = false): string {
  if (in_base) return `${fixed(x, 1)} m ahead   ${fixed(y, 1)} m left`;
  return `E ${fixed(x, 1)} m   N ${fixed(y, 1)} m`;
}
