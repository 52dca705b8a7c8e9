// SPDX-License-Identifier: Apache-2.0
// The plots of a run over the driven distance, with one zoom, and one cursor shared with the map.
import {Theme, kFleetDashes} from './color';
import {element} from './dom';
import {fixed, number} from './format';
import {Link} from './link';
import {motion_at} from './motion';
import {Part, Plot, PlotOptions, Shared} from './plot';
import {PlotData, Vehicle} from './types';

interface Column {
  key: 'error_m'|'steering_deg'|'soc'|'speed_mps'|'clearance_m';
  title: string;
  unit: string;
  options: PlotOptions;
}

/// Levels that must not be gone below: one for all vehicles, or each its own.
export function reserves(vehicles: Vehicle[]): {value: number, label: string}[] {
  const known = vehicles.filter((vehicle) => vehicle.reserve_soc !== undefined);
  const values = [...new Set(known.map((vehicle) => vehicle.reserve_soc!))];
  return values.map((value) => {
    const names = known.filter((vehicle) => vehicle.reserve_soc === value).map((vehicle) => vehicle.name);
    return {value, label: `Reserve ${fixed(100 * value, 0)} %` + (values.length > 1 ? ` (${names.join(', ')})` : '')};
  });
}

function columns(vehicles: Vehicle[]): Column[] {
  const percent = (value: number) => `${number(100 * value, 3)}`;
  return [
    {key: 'error_m', title: 'Cross-track error', unit: 'm, left positive',
     options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'steering_deg', title: 'Steering', unit: '\u00b0, left positive',
     options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'speed_mps', title: 'Speed', unit: 'm/s', options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'clearance_m', title: 'Clearance', unit: 'm to the nearest agent',
     options: {with_zero: true, y_format: (v) => number(v, 3)}},
    {key: 'soc', title: 'State of charge', unit: '%',
     options: {y_format: percent, references: reserves(vehicles), mark_label: 'charge'}},
  ];
}

function plot_data(column: Column, vehicles: Vehicle[]): PlotData {
  const series = vehicles.map((vehicle, i) => ({
    name: vehicle.name, x: vehicle.series[column.key].length ? vehicle.series.s_m : [], y: vehicle.series[column.key],
    dash: kFleetDashes[i % kFleetDashes.length],
    marks: column.key !== 'soc' ? [] : vehicle.stops.map((stop): [number, number] => [stop.s_m, stop.soc_from]),
  }));
  // A vehicle that stands still keeps its place, and with it the others their colours.
  return {title: column.title, x_label: 'distance [m]', y_label: column.unit, series};
}

// A single vehicle's plots show where it is at the time that the map shows.
function shared_by(link: Link, vehicles: Vehicle[]): Shared {
  const now = () => {
    const {time} = link.current;
    return time !== null && vehicles.length === 1 ? motion_at(vehicles[0]!.series, time).s : null;
  };
  return {
    cursor: () => link.current.cursor?.s ?? now(),
    set_cursor: (s) => link.set('cursor', s === null ? null : {s, vehicle: null}),
    range: () => link.current.range,
    set_range: (range) => link.set('range', range),
  };
}

/// The card with all plots whose column was measured, or null.
export function run_plots(vehicles: Vehicle[], link: Link, theme: () => Theme): Part|null {
  const shared = shared_by(link, vehicles);
  const several = vehicles.length > 1;
  const plots = columns(vehicles).filter((c) => vehicles.some((v) => v.series[c.key].length > 1)).map((c) => new Plot(
      plot_data(c, vehicles), {...c.options, height: several ? 240 : 150, left: 36}, shared, theme));
  if (plots.length === 0) return null;
  const reset = element('button', {type: 'button', class: 'quiet', hidden: true, click: () => link.set('range', null)},
                        'Show all');
  const hint = element('span', {class: 'hint'}, 'Drag to zoom');
  const repaint = () => plots.forEach((plot) => plot.repaint());
  link.listen((state, what) => {
    if (what === 'cursor' || what === 'time') plots.forEach((plot) => plot.repaint_cursor());
    if (what !== 'range') return;
    reset.hidden = state.range === null;
    hint.textContent = state.range ? `${fixed(state.range[0], 0)} to ${fixed(state.range[1], 0)} m` : 'Drag to zoom';
    repaint();
  });
  const head = element('header', {class: 'card-head'},
                       element('h2', {}, several ? 'Along the paths' : 'Along the path'), hint, reset);
  return {root: element('section', {class: 'card', 'aria-label': 'Plots'}, head, ...plots.map((p) => p.root)), repaint,
          repaint_now: () => plots.forEach((plot) => plot.repaint_now())};
}
