// SPDX-License-Identifier: Apache-2.0
// Run by node (see tests/CMakeLists.txt); throws at the first thing that is wrong.
import {oklch, ramp} from '../src/color';
import {bin_of, error_scale, kBins} from '../src/driven';
import {column_decimals, fixed, number} from '../src/format';
import {LayerSet} from '../src/layers';
import {Link} from '../src/link';
import {key_style, nearest} from '../src/plot';
import {reserves} from '../src/run_plots';
import {compare} from '../src/table';
import {contour, decode, gradient, light} from '../src/terrain';
import {line_points} from '../src/thin';
import {View, nearest_sample, round_length} from '../src/view';
import {subject} from '../src/why';

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
  const series = {s_m: [], x_m: [], y_m: [], error_m: [], steering_deg: [], soc: [], speed_mps: [], leg: []};
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

function a_leg_picked_twice_is_let_go(): void {
  const link = new Link();
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
                    vehicles_are_told_apart, a_leg_picked_twice_is_let_go, ground_and_screen_agree]) {
  test();
}
