// SPDX-License-Identifier: Apache-2.0

const kNone = 65535;
const kSteps = 65534;

/// The numbers that apps/packed_numbers.hpp packed: unsigned, 16 bits, little end first, in base64;
/// from 0 for `low` to 65534 for `high`; NaN where there is none.
export function unpack(text: string, low: number, high: number): Float32Array {
  const bytes = atob(text);
  const numbers = new Float32Array(Math.floor(bytes.length / 2));
  const step = (high - low) / kSteps;
  for (let i = 0; i < numbers.length; ++i) {
    const value = bytes.charCodeAt(2 * i) + 256 * bytes.charCodeAt(2 * i + 1);
    numbers[i] = value === kNone ? NaN : low + step * value;
  }
  return numbers;
}
