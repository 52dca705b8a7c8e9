// SPDX-License-Identifier: Apache-2.0
import {element} from './dom';
import {column_decimals, fixed, number, text_of} from './format';
import {Link} from './link';
import {TableData, Value} from './types';

const kSearchFrom = 9; // rows

/// Numbers before words, missing values last in either direction.
export function compare(a: Value|undefined, b: Value|undefined, direction: 1|-1): number {
  if (a === null || a === undefined) return b === null || b === undefined ? 0 : 1;
  if (b === null || b === undefined) return -1;
  if (typeof a === 'number' && typeof b === 'number') return direction * (a - b);
  if (typeof a === 'number') return -direction;
  if (typeof b === 'number') return direction;
  return direction * a.localeCompare(b, 'en', {numeric: true});
}

function number_format(values: Value[]): (value: number) => string {
  const numbers = values.filter((v): v is number => typeof v === 'number');
  const decimals = column_decimals(numbers);
  const spread = Math.max(...numbers.map(Math.abs)) >= 1e6 || numbers.some((v) => v !== 0 && Math.abs(v) < 10 ** -decimals);
  return (value) => spread || Math.abs(value) >= 10000 ? number(value) : fixed(value, decimals);
}

/// A table that sorts by its headers; a long one can be searched. Numbers of a column named "leg"
/// show that leg on the map: of the vehicle that a column of that name holds, or of the first.
export function table(data: TableData, link: Link|null, vehicles: string[] = []): HTMLElement {
  const column_of = (name: string) => data.columns.findIndex((column) => column.name.toLowerCase() === name);
  const leg_column = column_of('leg');
  const vehicle_column = column_of('vehicle');
  const body = element('tbody');
  const count = element('span', {class: 'hint', role: 'status'});
  const search = element('input', {type: 'search', placeholder: 'Search', 'aria-label': `Search in ${data.title}`});
  const is_number = data.columns.map((_, c) => data.rows.some((r) => typeof r[c] === 'number'));
  const formats = data.columns.map((_, c) => number_format(data.rows.map((r) => r[c] ?? null)));
  let sorted: {column: number, direction: 1|-1}|null = null;

  const cell = (row: Value[], c: number) => {
    const value = row[c];
    const text = typeof value === 'number' ? formats[c]!(value) : text_of(value);
    const td = element('td', {class: is_number[c] ? 'number' : ''});
    if (link && typeof value === 'number' && c === leg_column) {
      const vehicle = vehicle_column < 0 ? 0 : vehicles.indexOf(String(row[vehicle_column]));
      td.append(element('button', {type: 'button', class: 'link', title: 'Show on the map',
                                   click: () => link.toggle_leg({vehicle, leg: value})}, text));
    } else {
      td.textContent = text;
    }
    return td;
  };
  const fill = () => {
    const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let rows = data.rows.filter((row) => {
      const text = row.map(text_of).join(' ').toLowerCase();
      return words.every((word) => text.includes(word));
    });
    if (sorted) {
      const {column, direction} = sorted;
      rows = [...rows].sort((a, b) => compare(a[column], b[column], direction));
    }
    body.replaceChildren(...rows.map((row) => element('tr', {}, ...data.columns.map((_, c) => cell(row, c)))));
    count.textContent = rows.length === data.rows.length ? `${rows.length} rows` : `${rows.length} of ${data.rows.length} rows`;
  };
  const headers = data.columns.map((column, c) => {
    const unit = column.unit ? [' ', element('span', {class: 'unit'}, column.unit)] : [];
    const button = element('button', {type: 'button'}, column.name, ...unit);
    const header = element('th', {scope: 'col', class: is_number[c] ? 'number' : ''}, button);
    button.addEventListener('click', () => {
      sorted = {column: c, direction: sorted?.column === c && sorted.direction === 1 ? -1 : 1};
      for (const other of headers) other.removeAttribute('aria-sort');
      header.setAttribute('aria-sort', sorted.direction === 1 ? 'ascending' : 'descending');
      fill();
    });
    return header;
  });
  search.addEventListener('input', fill);
  fill();
  const long = data.rows.length >= kSearchFrom;
  const head = element('header', {class: 'card-head'}, element('h2', {}, data.title), count, ...(long ? [search] : []));
  return element('section', {class: 'card', 'aria-label': data.title}, head,
      element('div', {class: 'table-frame', tabindex: '0', role: 'region', 'aria-label': data.title},
          element('table', {}, element('thead', {}, element('tr', {}, ...headers)), body)));
}
