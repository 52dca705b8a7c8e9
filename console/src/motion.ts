// SPDX-License-Identifier: Apache-2.0
// Where vehicles and agents are at a moment, between the samples too.
import {bisectLeft} from 'd3-array';

import {unpack} from './packed';
import {Agents, Scene, Series} from './types';

export interface Motion {
  x: number;
  y: number;
  yaw: number;
  s: number;
  sample: number; // the one before
}

/// Whoever else is there, with his velocity.
export interface Seen {
  x: number;
  y: number;
  vx: number;
  vy: number;
  radius: number;
}

/// Whether times and headings of a drive are known.
export function plays(series: Series): boolean {
  return series.t_s.length > 1 && series.yaw_rad.length > 1;
}

/// First and last moment of all that plays, or null.
export function duration(scene: Scene): [number, number]|null {
  const series = scene.vehicles.map((vehicle) => vehicle.series).filter(plays);
  if (series.length === 0) return null;
  return [Math.min(...series.map((s) => s.t_s[0]!)), Math.max(...series.map((s) => s.t_s[s.t_s.length - 1]!))];
}

/// The sample before `t` and how far on to the next one it is; at the ends, the end.
function between(times: number[], t: number): [number, number] {
  const next = Math.min(Math.max(bisectLeft(times, t), 1), times.length - 1);
  const [from, to] = [times[next - 1]!, times[next]!];
  return [next - 1, to > from ? Math.min(1, Math.max(0, (t - from) / (to - from))) : 1];
}

/// The vehicle at `t`; headings turn the shorter way. Requires that the series plays.
export function motion_at(series: Series, t: number): Motion {
  const [i, share] = between(series.t_s, t);
  const mix = (column: number[]) => column[i]! + share * (column[i + 1]! - column[i]!);
  const turn = series.yaw_rad[i + 1]! - series.yaw_rad[i]!;
  return {
    x: mix(series.x_m), y: mix(series.y_m), s: mix(series.s_m),
    yaw: series.yaw_rad[i]! + share * Math.atan2(Math.sin(turn), Math.cos(turn)), sample: share < 1 ? i : i + 1,
  };
}

/// Those who move beside the vehicles.
export class Tracks {
  private readonly positions: Float32Array; // x, y, x, y, ... of one track after the other
  private readonly offsets: number[] = [];  // of each track, in positions

  constructor(private readonly agents: Agents) {
    this.positions = unpack(agents.positions, agents.low_m, agents.high_m);
    let offset = 0;
    for (const [, count] of agents.tracks) {
      this.offsets.push(offset);
      offset += 2 * count;
    }
  }

  at(t: number): Seen[] {
    const period = (t - this.agents.start_s) / this.agents.period_s;
    const seen: Seen[] = [];
    this.agents.tracks.forEach(([first, count, radius], track) => {
      const along = period - first;
      if (along < 0 || along > count - 1) return;
      const i = Math.min(Math.floor(along), Math.max(0, count - 2));
      const here = this.offsets[track]! + 2 * i;
      const next = count > 1 ? here + 2 : here;
      const [x, y] = [this.positions[here]!, this.positions[here + 1]!];
      const [dx, dy] = [this.positions[next]! - x, this.positions[next + 1]! - y];
      seen.push({x: x + (along - i) * dx, y: y + (along - i) * dy, vx: dx / this.agents.period_s,
                 vy: dy / this.agents.period_s, radius});
    });
    return seen;
  }
}
