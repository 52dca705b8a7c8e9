// SPDX-License-Identifier: Apache-2.0
// The plots of a run over the driven distance, with one zoom, and one cursor shared with the map.
import {Theme} from './color';
import {element} from './dom';
import {fixed, number} from './format';
import {Link} from './link';
import {Part, Plot, PlotOptions, Shared, nearest} from './plot';
import {Series} from './types';

interface Column {
  key: 'error_m'|'steering_deg'|'soc'|'speed_mps';
  title: string;
  unit: string;
  options: PlotOptions;
}

function columns(reserve: number|undefined): Column[] {
  const percent = (value: number) => `${number(100 * value, 3)}`;
  return [
    {key: 'error_m', title: 'Cross-track error', unit: 'm, left positive',
     options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'steering_deg', title: 'Steering', unit: '\u00b0, left positive',
     options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'speed_mps', title: 'Speed', unit: 'm/s', options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'soc', title: 'State of charge', unit: '%',
     options: {y_format: percent,
               reference: reserve === undefined ? undefined : {value: reserve, label: `Reserve ${fixed(100 * reserve, 0)} %`}}},
  ];
}

function shared_by(link: Link, s: number[]): Shared {
  return {
    cursor: () => link.current.sample === null ? null : s[link.current.sample] ?? null,
    set_cursor: (x) => link.set('sample', x === null ? null : nearest(s, x)),
    range: () => link.current.range,
    set_range: (range) => link.set('range', range),
  };
}

/// The card with all plots whose column was measured, or null.
export function run_plots(series: Series, reserve: number|undefined, link: Link,
                          theme: () => Theme): Part|null {
  const shared = shared_by(link, series.s_m);
  const plots = columns(reserve).filter((c) => series[c.key].length > 1).map((c) => new Plot(
      {title: c.title, x_label: 'distance [m]', y_label: c.unit, series: [{name: c.title, x: series.s_m, y: series[c.key]}]},
      {...c.options, height: 150, left: 36}, shared, theme));
  if (plots.length === 0) return null;
  const reset = element('button', {type: 'button', class: 'quiet', hidden: true, click: () => link.set('range', null)},
                        'Show all');
  const hint = element('span', {class: 'hint'}, 'Drag to zoom');
  const repaint = () => plots.forEach((plot) => plot.repaint());
  link.listen((state, what) => {
    if (what === 'sample') plots.forEach((plot) => plot.repaint_cursor());
    if (what !== 'range') return;
    reset.hidden = state.range === null;
    hint.textContent = state.range ? `${fixed(state.range[0], 0)} to ${fixed(state.range[1], 0)} m` : 'Drag to zoom';
    repaint();
  });
  const head = element('header', {class: 'card-head'}, element('h2', {}, 'Along the path'), hint, reset);
  return {root: element('section', {class: 'card', 'aria-label': 'Plots'}, head, ...plots.map((p) => p.root)), repaint,
          repaint_now: () => plots.forEach((plot) => plot.repaint_now())};
}
