// SPDX-License-Identifier: Apache-2.0
// What apps/report.cpp writes, and all that the page knows. Keys carry their unit.

export type Value = number | string | null;

export interface Tile {
  label: string;
  value: Value;
  unit?: string;
  hint?: string;
}

export type Position = [number, number]; // [m] east, north of the farm's origin
export type LegKind = 'row' | 'turn' | 'transit' | 'charge';

export interface Feature {
  kind: string; // a key of kLayers in layers.ts, or any other word (drawn in a neutral way)
  id?: string;
  name?: string;
  type: 'Polygon' | 'LineString' | 'Point';
  coordinates: Position | Position[] | Position[][];
  leg?: number;
  leg_kind?: LegKind;
}

/// Columns of equal length; a column that was not measured is empty.
export interface Series {
  s_m: number[];
  x_m: number[];
  y_m: number[];
  error_m: (number | null)[];
  steering_deg: (number | null)[];
  soc: (number | null)[];
  speed_mps: (number | null)[];
  leg: number[];
}

export interface TableData {
  title: string;
  columns: {name: string; unit?: string}[];
  rows: Value[][];
}

export interface PlotSeries {
  name: string;
  x: number[];
  y: (number | null)[];
  style?: 'line' | 'points';
}

export interface PlotData {
  title: string;
  x_label: string;
  y_label: string;
  log_y?: boolean;
  series: PlotSeries[];
}

export interface Report {
  title: string;
  kind: 'plan' | 'run' | 'study';
  status: string;
  version: string;
  seed: number;
  config_hash: string;
  config_yaml: string;
  tiles: Tile[];
  map: {features: Feature[]};
  series: Series;
  reserve_soc?: number;
  tables: TableData[];
  plots: PlotData[];
}
