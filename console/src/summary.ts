// SPDX-License-Identifier: Apache-2.0
// The head of the page, and the figures below it.
import {element} from './dom';
import {text_of} from './format';
import {Report, Tile} from './types';

const kGood = ['optimal', 'feasible', 'completed', 'complete', 'done', 'ok', 'passed'];
const kTilesAbreast = 7;
const kBad = ['failed', 'infeasible', 'error', 'aborted', 'collision'];

function status_class(status: string): string {
  const word = status.toLowerCase();
  if (kGood.includes(word)) return 'good';
  return kBad.includes(word) ? 'bad' : 'fair';
}

export function page_head(report: Report, theme_button: HTMLElement): HTMLElement {
  const kinds = {plan: 'Plan', run: 'Run', study: 'Study', scan: 'Scan'};
  const fact = (name: string, value: string) => element('div', {}, element('dt', {}, name), element('dd', {}, value));
  return element('header', {class: 'page-head'},
      element('div', {class: 'page-title'},
          element('p', {class: 'eyebrow'}, `Headland \u00b7 ${kinds[report.kind] ?? report.kind}`),
          element('h1', {}, report.title || 'Report',
              ...(report.status ? [element('span', {class: `badge ${status_class(report.status)}`}, report.status)] : []))),
      element('dl', {class: 'facts'}, fact('Version', report.version || '\u2013'), fact('Seed', String(report.seed)),
          fact('Configuration', report.config_hash || '\u2013')),
      theme_button);
}

function tile_node(tile: Tile): HTMLElement {
  const value = element('dd', {}, text_of(tile.value));
  if (tile.unit) value.append(element('span', {class: 'unit'}, tile.unit));
  const node = element('div', {class: 'tile'}, element('dt', {}, tile.label), value);
  if (tile.hint) node.append(element('p', {class: 'hint'}, tile.hint));
  return node;
}

export function tiles(list: Tile[]): HTMLElement {
  const columns = Math.ceil(list.length / Math.ceil(list.length / kTilesAbreast)); // rows of like length
  return element('dl', {class: 'tiles', 'aria-label': 'Summary', style: `--columns: ${columns}`}, ...list.map(tile_node));
}
