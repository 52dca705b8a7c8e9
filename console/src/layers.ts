// SPDX-License-Identifier: Apache-2.0
// The map's layers, bottom first: how each is drawn and called.
import {kFleetDashes, series_name} from './color';
import {Feature, LegKind, Terrain, Vehicle} from './types';

export type Mark = 'square'|'circle'|'diamond'|'bolt';

export interface Layer {
  key: string;
  label: string;
  fill?: string;   // names of colours in the style sheet
  stroke?: string;
  width?: number;  // [px]
  dash?: number[]; // [px]
  mark?: Mark;     // of points
}

export const kLayers: Layer[] = [
  {key: 'terrain', label: 'Relief'},
  {key: 'headland', label: 'Drivable area', fill: 'map-drivable'},
  {key: 'road', label: 'Roads', stroke: 'map-road', width: 3},
  {key: 'parcel', label: 'Parcels', fill: 'map-parcel', stroke: 'map-parcel-edge', width: 1.2},
  {key: 'keep_out', label: 'Keep-outs', fill: 'map-keep-out', stroke: 'map-keep-out-edge', width: 1},
  {key: 'contours', label: 'Contours', stroke: 'contour', width: 0.8},
  {key: 'points_ground', label: 'Ground', fill: 'map-road'},
  {key: 'points_low', label: 'Low points', fill: 'map-parcel-edge'},
  {key: 'points_high', label: 'High points', fill: 'map-row-done'},
  {key: 'cluster', label: 'Clusters', stroke: 'muted', width: 1},
  {key: 'row', label: 'Rows', stroke: 'map-row', width: 1.2},
  {key: 'row_done', label: 'Rows done', stroke: 'map-row-done', width: 2.4},
  {key: 'plan_row', label: 'Plan: rows', stroke: 'leg-row', width: 1.8},
  {key: 'plan_turn', label: 'Plan: turns', stroke: 'leg-turn', width: 1.8},
  {key: 'plan_transit', label: 'Plan: transit', stroke: 'leg-transit', width: 1.8},
  {key: 'plan_charge', label: 'Plan: to charge', stroke: 'leg-charge', width: 1.8, dash: [6, 4]},
  {key: 'driven', label: 'Driven', stroke: 'driven', width: 2.6},
  {key: 'lane_side', label: 'Sides of the lane', stroke: 'leg-turn', width: 2.4},
  {key: 'lane', label: 'Middle of the lane', stroke: 'leg-transit', width: 2.4, dash: [8, 5]},
  {key: 'row_end', label: 'End of the row', stroke: 'bad', width: 3},
  {key: 'goal', label: 'Goals', fill: 'map-goal', stroke: 'map-goal-edge', width: 1.2},
  {key: 'gate', label: 'Gates', stroke: 'map-gate', mark: 'square'},
  {key: 'poi', label: 'Places', stroke: 'map-poi', mark: 'circle'},
  {key: 'sensor', label: 'Vehicle', stroke: 'map-poi', mark: 'circle'},
  {key: 'charger', label: 'Chargers', stroke: 'leg-charge', mark: 'bolt'},
  {key: 'near_agent', label: 'Near-collision, the agent\u2019s doing', stroke: 'near-agent', mark: 'diamond'},
  {key: 'near_robot', label: 'Near-collision, the robot\u2019s doing', stroke: 'near-robot', mark: 'diamond'},
  {key: 'near_miss', label: 'Near misses', stroke: 'near-robot', mark: 'diamond'},
  {key: 'contact', label: 'Contact', stroke: 'bad', mark: 'square'},
  {key: 'given_up', label: 'Given up', stroke: 'bad', mark: 'square'},
];

const kOther: Layer = {key: 'other', label: 'Other', stroke: 'muted', width: 1, mark: 'diamond'};

const kLegLayers: Record<LegKind, string> = {
  row: 'plan_row',
  turn: 'plan_turn',
  transit: 'plan_transit',
  task: 'plan_transit',
  charge: 'plan_charge',
};

const kAliases: Record<string, string> = {drivable: 'headland', row_parcel: 'parcel', free_parcel: 'parcel'};

/// The layer of a kind of feature; a plan's depends on more.
export function layer_of(kind: string): Layer {
  return kLayers.find((layer) => layer.key === kind) ?? kOther;
}

/// The layers of one map. The plans of several vehicles are told apart by vehicle, that of a single
/// one by what is driven.
export class LayerSet {
  private readonly fleet: Layer[];

  constructor(vehicles: Vehicle[]) {
    this.fleet = vehicles.length < 2 ? [] : vehicles.map((vehicle, i) => ({
      key: `vehicle_${i}`, label: vehicle.name, stroke: series_name(i), width: 2, dash: kFleetDashes[i % kFleetDashes.length],
    }));
  }

  of(feature: Feature): Layer {
    const kind = kAliases[feature.kind] ?? feature.kind;
    if (kind !== 'plan') return layer_of(kind);
    const key = kLegLayers[feature.leg_kind ?? 'transit'] ?? 'plan_transit';
    return this.fleet[feature.vehicle ?? -1] ?? kLayers.find((layer) => layer.key === key)!;
  }

  /// Those that a map uses, bottom first.
  used(features: Feature[], driven: boolean, terrain: Terrain|undefined): Layer[] {
    const used = new Set(features.map((feature) => this.of(feature)));
    const shown = (layer: Layer) => used.has(layer) || (driven && layer.key === 'driven') ||
        (terrain !== undefined && (layer.key === 'terrain' || layer.key === 'contours'));
    const plans = kLayers.findIndex((layer) => layer.key === 'plan_row');
    return [...kLayers.slice(0, plans), ...this.fleet, ...kLayers.slice(plans), kOther].filter(shown);
  }
}

/// Rings or lines of a feature; a point is a line of one position.
export function lines_of(feature: Feature): [number, number][][] {
  switch (feature.type) {
    case 'Point':
      return [[feature.coordinates as [number, number]]];
    case 'MultiPoint':
      return (feature.coordinates as [number, number][]).map((position) => [position]);
    case 'LineString':
      return [feature.coordinates as [number, number][]];
    case 'Polygon':
      return feature.coordinates as [number, number][][];
  }
}
