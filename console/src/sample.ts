// SPDX-License-Identifier: Apache-2.0
import {element} from './dom';
import {clock, fixed} from './format';
import {Series} from './types';

/// What was measured at a sample, as pairs of name and value with its unit.
export function describe_sample(series: Series, i: number, vehicle = ''): [string, string][] {
  const rows: [string, string][] = vehicle ? [['Vehicle', vehicle]] : [];
  if (series.t_s.length) rows.push(['Time', clock(series.t_s[i]!)]);
  rows.push(['Distance', fixed(series.s_m[i], 1) + ' m']);
  const percent = series.soc[i];
  if (series.error_m.length) rows.push(['Error', fixed(series.error_m[i], 3) + ' m']);
  if (series.steering_deg.length) rows.push(['Steering', fixed(series.steering_deg[i], 1) + '\u00b0']);
  if (series.speed_mps.length) rows.push(['Speed', fixed(series.speed_mps[i], 2) + ' m/s']);
  if (series.clearance_m.length) rows.push(['Clearance', fixed(series.clearance_m[i], 2) + ' m']);
  if (percent !== undefined && percent !== null) rows.push(['Charge', fixed(100 * percent, 1) + ' %']);
  if (series.leg.length) rows.push(['Leg', String(series.leg[i])]);
  return rows;
}

export function sample_rows(series: Series, i: number, vehicle = ''): HTMLElement[] {
  return describe_sample(series, i, vehicle).map(
      ([name, value]) => element('div', {}, element('span', {}, name), element('b', {}, value)));
}
