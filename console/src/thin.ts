// SPDX-License-Identifier: Apache-2.0
import {bisectLeft} from 'd3-array';

interface Points {
  x: number[];
  y: (number|null)[];
}

/// The screen points of a line over a rising x; where several fall on one column of pixels, its
/// lowest and highest, so that no peak is lost. A null y is a gap.
export function line_points(points: Points, to_x: (x: number) => number, to_y: (y: number|null) => number|null,
                            pixels: [number, number]): [number, number|null][] {
  const rising = points.x.length < 2 || points.x[0]! <= points.x[points.x.length - 1]!;
  const invert = (px: number) => {
    const [x0, x1] = [to_x(0), to_x(1)];
    return (px - x0) / (x1 - x0);
  };
  const first = rising ? Math.max(0, bisectLeft(points.x, invert(pixels[0])) - 1) : 0;
  const last = rising ? Math.min(points.x.length - 1, bisectLeft(points.x, invert(pixels[1]))) : points.x.length - 1;
  const result: [number, number|null][] = [];
  if (last - first < 3 * (pixels[1] - pixels[0])) {
    for (let i = first; i <= last; ++i) result.push([to_x(points.x[i]!), to_y(points.y[i]!)]);
    return result;
  }
  let column = NaN;
  let low = 0;
  let high = 0;
  const flush = () => {
    if (Number.isNaN(column)) return;
    result.push([column, low]);
    if (high !== low) result.push([column, high]);
  };
  for (let i = first; i <= last; ++i) {
    const y = to_y(points.y[i]!);
    const px = Math.round(to_x(points.x[i]!));
    if (y === null) {
      flush();
      column = NaN;
      result.push([px, null]);
    } else if (px !== column) {
      flush();
      column = px;
      low = high = y;
    } else {
      low = Math.min(low, y);
      high = Math.max(high, y);
    }
  }
  flush();
  return result;
}
