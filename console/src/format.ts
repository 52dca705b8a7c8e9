// SPDX-License-Identifier: Apache-2.0
import {Value} from './types';

const kThinSpace = '\u202f';
const kMinus = '\u2212';

function grouped(digits: string): string {
  return digits.length < 5 ? digits : digits.replace(/\B(?=(\d{3})+$)/g, kThinSpace);
}

/// A number with about `significant` digits, thousands grouped, a true minus sign.
export function number(value: number, significant = 4): string {
  if (!Number.isFinite(value)) return value > 0 ? '\u221e' : value < 0 ? kMinus + '\u221e' : '\u2013';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e9)) {
    const [mantissa, exponent] = value.toExponential(significant - 1).split('e');
    return `${Number(mantissa)}e${Number(exponent)}`.replace(/-/g, kMinus);
  }
  const before = size < 1 ? 0 : Math.floor(Math.log10(size)) + 1;
  const leading = size > 0 && size < 1 ? Math.max(0, -Math.floor(Math.log10(size)) - 1) : 0;
  const decimals = Number.isInteger(value) ? 0 : Math.max(0, significant - before + leading);
  const [whole = '0', fraction = ''] = size.toFixed(Math.min(decimals, 8)).split('.');
  const kept = fraction.replace(/0+$/, '');
  const text = grouped(whole) + (kept ? '.' + kept : '');
  return value < 0 && Number(text.replace(/\u202f/g, '')) !== 0 ? kMinus + text : text;
}

/// A fixed number of decimals, so that columns and read-outs do not jump.
export function fixed(value: number|null|undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  const text = Math.abs(value).toFixed(decimals);
  return value < 0 && Number(text) !== 0 ? kMinus + text : text;
}

export function text_of(value: Value|undefined): string {
  if (value === null || value === undefined) return '\u2013';
  return typeof value === 'number' ? number(value) : value;
}

/// Decimals that tell the values of a column apart with `significant` digits of the largest.
export function column_decimals(values: number[], significant = 4): number {
  const finite = values.filter(Number.isFinite);
  if (finite.every(Number.isInteger)) return 0;
  const largest = Math.max(...finite.map(Math.abs));
  const before = largest < 1 ? 0 : Math.floor(Math.log10(largest)) + 1;
  return Math.min(4, Math.max(0, significant - before));
}

/// A length for people: 12.3 m, 1.24 km.
export function distance(metres: number): string {
  return metres >= 1000 ? `${number(metres / 1000)} km` : `${number(metres)} m`;
}

/// A time for people: 1:07.5, 1:02:03.0.
export function clock(seconds: number): string {
  const tenths = Math.round(10 * Math.max(0, seconds));
  const [hours, minutes] = [Math.floor(tenths / 36000), Math.floor(tenths / 600) % 60];
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, '0');
  return hours > 0 ? `${hours}:${String(minutes).padStart(2, '0')}:${rest}` : `${minutes}:${rest}`;
}
