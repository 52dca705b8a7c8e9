// SPDX-License-Identifier: Apache-2.0
// The relief below the map: heights tinted and lit from the north-west, and contour lines.
import {oklch_rgb} from './color';
import {unpack} from './packed';
import {Position, Terrain} from './types';
import {round_length} from './view';

const kContours = 8;        // about so many
const kShownSlope = 0.4;    // what the steeper slopes are exaggerated to [m/m]
const kMostExaggeration = 8;

/// Heights [m] row by row from the south-west; NaN where there is none.
export function decode(terrain: Terrain): Float32Array {
  return unpack(terrain.heights, terrain.low_m, terrain.high_m);
}

/// Gradient [m/m] to the east and north at grid point i; one-sided at edges, NaN beside a gap.
export function gradient(heights: Float32Array, columns: number, rows: number, cell: number,
                         i: number): [number, number] {
  const [column, row] = [i % columns, Math.floor(i / columns)];
  const along = (at: number, count: number, stride: number) => {
    const before = at > 0 ? i - stride : i;
    const after = at < count - 1 ? i + stride : i;
    return after === before ? 0 : (heights[after]! - heights[before]!) / (((after - before) / stride) * cell);
  };
  return [along(column, columns, 1), along(row, rows, columns)];
}

/// Light on a slope from a sun in the north-west, 45 degrees high; 1 on level ground.
export function light(east: number, north: number): number {
  return Math.max(0, (0.5 * east - 0.5 * north + Math.SQRT1_2) / Math.hypot(east, north, 1) / Math.SQRT1_2);
}

/// Where a level crosses the grid: pieces of its contour as x0, y0, x1, y1 in grid units.
export function contour(heights: Float32Array, columns: number, rows: number, level: number): number[][] {
  const pieces: number[][] = [];
  for (let row = 0; row + 1 < rows; ++row) {
    for (let column = 0; column + 1 < columns; ++column) {
      const i = row * columns + column;
      const corners = [[column, row, heights[i]!], [column + 1, row, heights[i + 1]!],
                       [column + 1, row + 1, heights[i + columns + 1]!], [column, row + 1, heights[i + columns]!]];
      if (corners.some((corner) => Number.isNaN(corner[2]))) continue;
      const crossings: number[][] = [];
      corners.forEach(([x0, y0, h0], k) => {
        const [x1, y1, h1] = corners[(k + 1) % 4] as [number, number, number];
        if ((h0! < level) === (h1 < level)) return;
        const t = (level - h0!) / (h1 - h0!);
        crossings.push([x0! + t * (x1 - x0!), y0! + t * (y1 - y0!)]);
      });
      for (let k = 0; k + 1 < crossings.length; k += 2) pieces.push([...crossings[k]!, ...crossings[k + 1]!]);
    }
  }
  return pieces;
}

/// Colour of a height between lowest (0) and highest (1) in a light.
function tint(t: number, lit: number, dark: boolean): [number, number, number] {
  const lightness = dark ? (0.27 + 0.17 * t) * (0.4 + 0.6 * lit) : Math.min(0.985, (0.86 + 0.06 * t) * (0.62 + 0.38 * lit));
  return oklch_rgb(lightness, dark ? 0.04 : 0.045, 145 - 75 * t);
}

export function tint_text(t: number, dark: boolean): string {
  return `rgb(${tint(t, 1, dark).join(',')})`;
}

export class Relief {
  readonly interval_m: number; // of the contours
  private readonly heights: Float32Array;
  private readonly images = new Map<boolean, HTMLCanvasElement>();
  private lines: Path2D|null = null;

  constructor(private readonly terrain: Terrain) {
    this.heights = decode(terrain);
    this.interval_m = round_length(Math.max((terrain.high_m - terrain.low_m) / (kContours / 2), 1e-3));
  }

  /// In a context whose unit is the metre, counted from `origin`, north up.
  paint(context: CanvasRenderingContext2D, origin: Position, dark: boolean): void {
    const {cell_m: cell, columns, rows, south_west_m: [x, y]} = this.terrain;
    if (columns * rows === 0) return;
    let image = this.images.get(dark);
    if (!image) this.images.set(dark, image = this.draw(dark));
    context.imageSmoothingQuality = 'high';
    context.drawImage(image, x - origin[0] - cell / 2, y - origin[1] - cell / 2, columns * cell, rows * cell);
  }

  contours(origin: Position): Path2D {
    if (this.lines) return this.lines;
    const {cell_m: cell, columns, rows, low_m, high_m, south_west_m: [x, y]} = this.terrain;
    const path = this.lines = new Path2D();
    for (let n = Math.floor(low_m / this.interval_m) + 1; n * this.interval_m < high_m; ++n) {
      for (const [x0, y0, x1, y1] of contour(this.heights, columns, rows, n * this.interval_m)) {
        path.moveTo(x + cell * x0! - origin[0], y + cell * y0! - origin[1]);
        path.lineTo(x + cell * x1! - origin[0], y + cell * y1! - origin[1]);
      }
    }
    return path;
  }

  // One pixel per grid point, the southern row first.
  private draw(dark: boolean): HTMLCanvasElement {
    const {columns, rows, cell_m, low_m, high_m} = this.terrain;
    const canvas = document.createElement('canvas');
    canvas.width = columns;
    canvas.height = rows;
    const context = canvas.getContext('2d')!;
    const image = context.createImageData(columns, rows);
    const slopes = Array.from(this.heights, (_, i) => gradient(this.heights, columns, rows, cell_m, i));
    const steepness = slopes.map((s) => Math.hypot(...s)).filter(Number.isFinite).sort((a, b) => a - b);
    const steep = steepness[Math.floor(0.9 * steepness.length)] ?? 0;
    const exaggeration = Math.min(kMostExaggeration, Math.max(1, kShownSlope / Math.max(steep, 1e-6)));
    slopes.forEach(([east, north], i) => {
      const height = this.heights[i]!;
      if (Number.isNaN(height)) return; // stays clear
      const lit = Number.isFinite(east + north) ? light(exaggeration * east, exaggeration * north) : 1;
      const t = high_m > low_m ? (height - low_m) / (high_m - low_m) : 0;
      image.data.set([...tint(t, lit, dark), 255], 4 * i);
    });
    context.putImageData(image, 0, 0);
    return canvas;
  }
}
