// SPDX-License-Identifier: Apache-2.0
// The driven path as one drawable path per colour of the error ramp.
import {Series} from './types';

export const kBins = 32;

/// The |error| that all but 1% of the samples stay below, rounded up to 1, 2 or 5 x 10^n: one bad
/// sample must not wash out the others.
export function error_scale(errors: (number|null)[]): number {
  const sizes = errors.filter((e): e is number => e !== null).map(Math.abs).sort((a, b) => a - b);
  const high = sizes.length ? sizes[Math.floor(0.99 * (sizes.length - 1))]! : 0;
  if (high <= 0) return 0.1;
  const power = 10 ** Math.floor(Math.log10(high));
  return [1, 2, 5, 10].map((f) => f * power).find((v) => v >= high * 0.999) ?? 10 * power;
}

export function bin_of(error: number|null|undefined, full_scale: number): number {
  if (error === null || error === undefined) return 0;
  return Math.min(kBins - 1, Math.floor(Math.abs(error) / full_scale * kBins));
}

export function empty_bins(): Path2D[] {
  return Array.from({length: kBins}, () => new Path2D());
}

/// Adds samples `first` to `last`, relative to the origin given.
export function add_driven(bins: Path2D[], series: Series, full_scale_m: number, origin: [number, number],
                           first: number, last: number): void {
  const [origin_x, origin_y] = origin;
  let bin = -1;
  for (let i = first + 1; i <= last; ++i) {
    const next = bin_of(series.error_m[i], full_scale_m);
    if (next !== bin) {
      bins[next]!.moveTo(series.x_m[i - 1]! - origin_x, series.y_m[i - 1]! - origin_y);
      bin = next;
    }
    bins[bin]!.lineTo(series.x_m[i]! - origin_x, series.y_m[i]! - origin_y);
  }
}
