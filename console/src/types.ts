// SPDX-License-Identifier: Apache-2.0
// What apps/report.cpp writes, and all that the page knows. Keys carry their unit.

export type Value = number | string | null;

export interface Tile {
  label: string;
  value: Value;
  unit?: string;
  hint?: string;
}

export type Position = [number, number]; // [m] east, north of the farm's origin; of a scan: ahead, to the left
export type LegKind = 'row' | 'turn' | 'transit' | 'task' | 'charge';

export interface Feature {
  kind: string; // a key of kLayers in layers.ts, or any other word (drawn in a neutral way)
  id?: string;
  name?: string;
  type: 'Polygon' | 'LineString' | 'Point' | 'MultiPoint';
  coordinates: Position | Position[] | Position[][];
  vehicle?: number; // of Report.vehicles
  leg?: number;
  leg_kind?: LegKind;
  t_s?: number; // when it happened, on the clock of the series
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
  t_s: number[]; // since the start; with yaw_rad: the drive can be played
  yaw_rad: number[];
  clearance_m: (number | null)[]; // to the nearest agent, outline to outline
}

/// A charge on the way.
export interface Stop {
  s_m: number;
  soc_from: number;
  soc_to: number;
  name: string;
}

export interface Vehicle {
  name: string;
  reserve_soc?: number;
  series: Series;
  stops: Stop[];
  outline?: {front_m: number; rear_m: number; width_m: number};
}

/// Those who move beside the vehicles: for each the period of the first position, their number, and
/// the radius [m]; x and y of all of them one after the other, packed (packed.ts).
export interface Agents {
  start_s: number;
  period_s: number;
  tracks: [number, number, number][];
  low_m: number;
  high_m: number;
  positions: string;
}

/// Heights on a grid of points, row by row from the south-west: unsigned, 16 bits, little end first,
/// in base64; from 0 for low_m to 65534 for high_m, 65535 where there is none.
export interface Terrain {
  south_west_m: Position;
  cell_m: number;
  columns: number;
  rows: number;
  low_m: number;
  high_m: number;
  heights: string;
}

/// Why a leg is there, or a task is not.
export interface Reason {
  vehicle?: number;
  leg?: number;
  text: string;
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
  dash?: number[];            // [px]
  marks?: [number, number][]; // events on the line
}

export interface PlotData {
  title: string;
  x_label: string;
  y_label: string;
  log_y?: boolean;
  series: PlotSeries[];
}

/// What a map shows, and plays if the vehicles' series have times.
export interface Scene {
  in_base?: boolean; // a vehicle's surroundings: x ahead, y to its left
  map: {features: Feature[]};
  vehicles: Vehicle[];
  terrain?: Terrain;
  agents?: Agents;
}

/// A drive among others of its kind.
export interface Episode {
  name: string;
  note: string;
  scene: Scene;
}

export interface Report extends Scene {
  title: string;
  kind: 'plan' | 'run' | 'study' | 'scan';
  status: string;
  version: string;
  seed: number;
  config_hash: string;
  config_yaml: string;
  tiles: Tile[];
  why: Reason[];
  tables: TableData[];
  plots: PlotData[];
  episodes: Episode[];
}
