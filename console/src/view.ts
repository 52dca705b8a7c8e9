// SPDX-License-Identifier: Apache-2.0
// Where the map's ground lies on the screen.

export interface Bounds {
  min_x: number;
  min_y: number;
  max_x: number;
  max_y: number;
}

export function empty_bounds(): Bounds {
  return {min_x: Infinity, min_y: Infinity, max_x: -Infinity, max_y: -Infinity};
}

export function extend(bounds: Bounds, x: number, y: number): void {
  bounds.min_x = Math.min(bounds.min_x, x);
  bounds.min_y = Math.min(bounds.min_y, y);
  bounds.max_x = Math.max(bounds.max_x, x);
  bounds.max_y = Math.max(bounds.max_y, y);
}

const kFoot = 48; // px at the bottom, for the scale and colour bars

/// Ground to screen before zooming: north up, all of the bounds visible.
export class View {
  readonly scale: number; // [px/m]
  private readonly center_py: number;
  private readonly center_x: number;
  private readonly center_y: number;

  constructor(bounds: Bounds, private readonly width: number, height: number, margin = 28) {
    const wide = Math.max(bounds.max_x - bounds.min_x, 1);
    const high = Math.max(bounds.max_y - bounds.min_y, 1);
    const foot = Math.min(kFoot, 0.12 * height);
    this.center_py = (height - foot) / 2;
    this.scale = Math.min(Math.max(width - 2 * margin, 40) / wide, Math.max(height - foot - 2 * margin, 40) / high);
    this.center_x = (bounds.min_x + bounds.max_x) / 2;
    this.center_y = (bounds.min_y + bounds.max_y) / 2;
  }
  to_screen(x: number, y: number): [number, number] {
    return [this.width / 2 + (x - this.center_x) * this.scale,
            this.center_py - (y - this.center_y) * this.scale];
  }
  to_ground(px: number, py: number): [number, number] {
    return [this.center_x + (px - this.width / 2) / this.scale,
            this.center_y - (py - this.center_py) / this.scale];
  }
}

/// The roundest of 1, 2, 5 x 10^n that is at most `limit`.
export function round_length(limit: number): number {
  const power = 10 ** Math.floor(Math.log10(limit));
  for (const factor of [5, 2]) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

/// Index of the sample nearest to (x, y), or -1 if none is nearer than `limit`.
export function nearest_sample(xs: number[], ys: number[], x: number, y: number, limit: number): number {
  let best = -1;
  let best_squared = limit * limit;
  for (let i = 0; i < xs.length; ++i) {
    const dx = xs[i]! - x;
    const dy = ys[i]! - y;
    const squared = dx * dx + dy * dy;
    if (squared < best_squared) {
      best = i;
      best_squared = squared;
    }
  }
  return best;
}
