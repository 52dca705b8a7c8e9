// SPDX-License-Identifier: Apache-2.0
// Run by node (see tests/CMakeLists.txt); throws at the first thing that is wrong.
import {oklch, ramp} from '../src/color';
import {bin_of, error_scale, kBins} from '../src/driven';
import {clock, column_decimals, fixed, number} from '../src/format';
import {LayerSet} from '../src/layers';
import {Link} from '../src/link';
import {key_style, nearest} from '../src/plot';
import {reserves} from '../src/run_plots';
import {compare} from '../src/table';
import {contour, decode, gradient, light} from '../src/terrain';
import {line_points} from '../src/thin';
import {View, nearest_sample, round_length} from '../src/view';
import {subject} from '../src/why';
import {Tracks, duration, motion_at, plays} from '../src/motion';
import {events_of, first_rate} from '../src/player';
import {Scene, Series} from '../src/types';

function equal(actual: unknown, expected: unknown, what: string): void {
  const [a, b] = [JSON.stringify(actual), JSON.stringify(expected)];
  if (a !== b) throw new Error(`${what}: ${a} instead of ${b}`);
}

function numbers_are_written_for_people(): void {
  equal(number(0.04712), '0.04712', 'small');
  equal(number(1234.56), '1235', 'four digits');
  equal(number(12345678), '12\u202f345\u202f678', 'grouped');
  equal(number(-2.5), '\u22122.5', 'minus');
  equal(number(0), '0', 'zero');
  equal(number(1.5e-7), '1.5e\u22127', 'tiny');
  equal(number(9.9999), '10', 'rounds up');
  equal(fixed(-0.001, 1), '0.0', 'no minus zero');
  equal(fixed(null, 1), '\u2013', 'missing');
  equal(column_decimals([1, 2, 3]), 0, 'whole numbers');
  equal(column_decimals([0.5, 12.25]), 2, 'four digits of the largest');
}

function rows_sort(): void {
  const sorted = (direction: 1|-1) => [null, 'b10', 3, 'b9', -1].sort((a, b) => compare(a, b, direction));
  equal(sorted(1), [-1, 3, 'b9', 'b10', null], 'rising');
  equal(sorted(-1), ['b10', 'b9', 3, -1, null], 'falling, missing still last');
}

function lines_keep_their_peaks(): void {
  const x = Array.from({length: 100000}, (_, i) => i);
  const y: (number|null)[] = x.map(() => 0);
  y[54321] = 7;
  y[777] = null;
  const points = line_points({x, y}, (v) => v / 1000, (v) => v, [0, 100]);
  if (points.length > 300) throw new Error(`not thinned out: ${points.length}`);
  equal(points.some(([, py]) => py === 7), true, 'peak');
  equal(points.some(([, py]) => py === null), true, 'gap');
  const few = line_points({x: [0, 1, 2], y: [1, 2, 3]}, (v) => v, (v) => v, [0, 100]);
  equal(few, [[0, 1], [1, 2], [2, 3]], 'short lines stay whole');
}

function lightness_of(color: string): number {
  const [r, g, b] = color.match(/\d+/g)!.map(Number) as [number, number, number];
  return 0.2126 * (r / 255) ** 2.2 + 0.7152 * (g / 255) ** 2.2 + 0.0722 * (b / 255) ** 2.2;
}

function ramps_run_one_way(): void {
  for (const dark of [false, true]) {
    for (let i = 1; i <= 20; ++i) {
      const step = lightness_of(ramp(i / 20, dark)) - lightness_of(ramp((i - 1) / 20, dark));
      if (dark ? step <= 0 : step >= 0) throw new Error(`ramp turns at ${i} (dark ${dark})`);
    }
  }
  equal(oklch(1, 0, 0), 'rgb(255,255,255)', 'white');
  equal(oklch(0, 0, 0), 'rgb(0,0,0)', 'black');
}

function errors_find_their_colour(): void {
  equal(error_scale([0.01, -0.03, null]), 0.01, 'the one bad of few does not set the scale');
  equal(error_scale([...Array(200).fill(0.04), 9]), 0.05, 'nor of many');
  equal(error_scale([]), 0.1, 'nothing measured');
  equal([bin_of(0, 1), bin_of(-0.5, 1), bin_of(2, 1)], [0, kBins / 2, kBins - 1], 'bins');
}

function relief_is_lit_from_the_north_west(): void {
  const terrain = {south_west_m: [0, 0] as [number, number], cell_m: 2, columns: 3, rows: 2, low_m: 10, high_m: 20,
                   heights: btoa(String.fromCharCode(0, 0, 254, 255, 255, 255, 0, 0, 255, 127, 254, 255))};
  const heights = decode(terrain);
  equal([...heights].map((h) => Number.isNaN(h) ? null : Math.round(100 * h) / 100), [10, 20, null, 10, 15, 20], 'decoded');
  equal(gradient(Float32Array.from([0, 2, 4, 6, 8, 10]), 3, 2, 2, 4), [1, 3], 'gradient');
  equal(light(0, 0), 1, 'level');
  if (light(0.3, -0.3) <= 1) throw new Error('a slope that faces the sun is in shadow'); // falls to the north-west
  if (light(-0.3, 0.3) >= 1) throw new Error('a slope in the lee is lit');
}

function contours_lie_at_their_level(): void {
  const plane = Float32Array.from([0, 1, 2, 0, 1, 2]); // rises to the east
  equal(contour(plane, 3, 2, 0.25), [[0.25, 0, 0.25, 1]], 'across one cell');
  equal(contour(plane, 3, 2, 5), [], 'above all');
  equal(contour(Float32Array.from([0, NaN, 2, 0, 1, 2]), 3, 2, 0.25), [], 'not beside a gap');
  const saddle = contour(Float32Array.from([1, 0, 0, 1]), 2, 2, 0.5);
  equal(saddle.length, 2, 'two pieces in a saddle');
}

function vehicles_are_told_apart(): void {
  const series = {s_m: [], x_m: [], y_m: [], error_m: [], steering_deg: [], soc: [], speed_mps: [], leg: [],
                  t_s: [], yaw_rad: [], clearance_m: []};
  const vehicle = (name: string, reserve_soc: number) => ({name, reserve_soc, series, stops: []});
  const plan = {kind: 'plan', type: 'LineString' as const, coordinates: [], leg_kind: 'row' as const, vehicle: 1};
  const fleet = new LayerSet([vehicle('a', 0.1), vehicle('b', 0.2)]);
  equal(fleet.of(plan).label, 'b', 'by vehicle');
  equal(fleet.of(plan) === fleet.of({...plan, leg_kind: 'turn'}), true, 'whatever it drives');
  equal(fleet.used([plan], false, undefined).map((layer) => layer.label), ['b'], 'those on the map');
  equal(new LayerSet([vehicle('a', 0.1)]).of({...plan, vehicle: 0}).key, 'plan_row', 'one alone by kind');
  equal(reserves([vehicle('a', 0.1), vehicle('b', 0.1)]).map((r) => r.label), ['Reserve 10 %'], 'one reserve');
  equal(reserves([vehicle('a', 0.1), vehicle('b', 0.2)]).map((r) => r.label), ['Reserve 10 % (a)', 'Reserve 20 % (b)'],
        'two reserves');
  equal(key_style('x', [6, 2]), 'background: repeating-linear-gradient(90deg, var(--x) 0px 6px, transparent 6px 8px)', 'dash');
  equal(subject({text: '', vehicle: 1, leg: 7}, ['a', 'b']), 'b, leg 7', 'subject');
  equal(subject({text: '', vehicle: 0, leg: 7}, ['a']), 'leg 7', 'of one vehicle');
}

function drive(): Series {
  return {s_m: [0, 2, 2], x_m: [0, 2, 2], y_m: [5, 5, 5], error_m: [], steering_deg: [], soc: [], speed_mps: [], leg: [],
          t_s: [0, 2, 3], yaw_rad: [3, -3, -3], clearance_m: []};
}

function vehicles_move_between_samples(): void {
  const series = drive();
  const at = motion_at(series, 1);
  equal([at.x, at.y, at.s, at.sample], [1, 5, 1, 0], 'halfway');
  equal(Math.cos(at.yaw).toFixed(6), '-1.000000', 'turned the shorter way');
  equal([motion_at(series, -5).x, motion_at(series, 9).x], [0, 2], 'at the ends');
  equal([motion_at(series, 2).sample, motion_at(series, 9).sample], [1, 2], 'the sample before');
  equal(plays({...series, yaw_rad: []}), false, 'not without headings');
}

// Two tracks of positions 0, 10 and 20 m, packed: 0, 32767 and 65534.
function agents_come_and_go(): void {
  const words = [0, 0, 32767, 0, 65534, 65534];
  const positions = btoa(String.fromCharCode(...words.flatMap((w) => [w % 256, Math.floor(w / 256)])));
  const tracks = new Tracks({start_s: 1, period_s: 0.5, tracks: [[2, 2, 0.5], [3, 1, 0.3]], low_m: 0, high_m: 20, positions});
  const seen = (t: number) => tracks.at(t).map((a) => [a.x, a.y, a.vx, a.radius]);
  equal(seen(1.9), [], 'not yet');
  equal(seen(2.25), [[5, 0, 20, 0.5]], 'between two positions');
  equal(seen(2.5), [[10, 0, 20, 0.5], [20, 20, 0, 0.3]], 'one of a single position');
  equal(seen(2.6), [], 'gone');
}

function scenes_know_how_long_they_last(): void {
  const mark = (t_s: number) => ({kind: 'contact', type: 'Point' as const, coordinates: [0, 0] as [number, number], t_s});
  const vehicle = (series: Series) => ({name: '', series, stops: []});
  const later = {...drive(), t_s: [1, 2, 9]};
  const scene: Scene = {map: {features: [mark(7), {...mark(1), t_s: undefined}, mark(3)]}, vehicles: [vehicle(drive()), vehicle(later)]};
  equal(duration(scene), [0, 9], 'of all');
  equal(duration({...scene, vehicles: []}), null, 'nothing that plays');
  equal(events_of(scene).map((e) => e.t_s), [3, 7], 'in order');
  equal(new Link(scene).current.time, 0, 'from its beginning');
  equal([20, 120, 1e6].map(first_rate), [1, 2, 300], 'rates');
  equal([7.46, 67.5, 3723.04].map(clock), ['0:07.5', '1:07.5', '1:02:03.0'], 'clock');
}

function a_leg_picked_twice_is_let_go(): void {
  const link = new Link({map: {features: []}, vehicles: []});
  link.toggle_leg({vehicle: 1, leg: 4});
  link.toggle_leg({vehicle: 0, leg: 4});
  equal(link.current.leg, {vehicle: 0, leg: 4}, 'the same leg of another vehicle');
  link.toggle_leg({vehicle: 0, leg: 4});
  equal(link.current.leg, null, 'let go');
}

function ground_and_screen_agree(): void {
  const view = new View({min_x: -10, min_y: 0, max_x: 30, max_y: 80}, 400, 600);
  const [x, y] = view.to_ground(...view.to_screen(12, 34));
  equal([x.toFixed(9), y.toFixed(9)], ['12.000000000', '34.000000000'], 'round trip');
  equal(view.to_screen(0, 80)[1] < view.to_screen(0, 0)[1], true, 'north is up');
  equal([99, 100, 0.3].map(round_length), [50, 100, 0.2], 'round lengths');
  equal(nearest_sample([0, 10], [0, 0], 8, 0, 3), 1, 'near');
  equal(nearest_sample([0, 10], [0, 0], 5, 0, 3), -1, 'too far');
  equal([-1, 1.4, 1.6, 9].map((v) => nearest([0, 1, 2], v)), [0, 1, 2, 2], 'nearest in a list');
}

for (const test of [numbers_are_written_for_people, rows_sort, lines_keep_their_peaks, ramps_run_one_way,
                    errors_find_their_colour, relief_is_lit_from_the_north_west, contours_lie_at_their_level,
                    vehicles_are_told_apart, vehicles_move_between_samples, agents_come_and_go,
                    scenes_know_how_long_they_last, a_leg_picked_twice_is_let_go, ground_and_screen_agree]) {
  test();
}
