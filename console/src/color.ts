// SPDX-License-Identifier: Apache-2.0
// Colours of the canvases: those of the style sheet, and a ramp that stays readable for the colour
// blind because its lightness runs one way.

/// sRGB of a colour in Ottosson's OKLCH (2020), clipped to the gamut; hue in degrees.
export function oklch_rgb(lightness: number, chroma: number, hue: number): [number, number, number] {
  const a = chroma * Math.cos(hue * Math.PI / 180);
  const b = chroma * Math.sin(hue * Math.PI / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3;
  const channel = (linear: number) => {
    const value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
    return Math.round(255 * Math.min(1, Math.max(0, value)));
  };
  return [channel(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          channel(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          channel(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)];
}
export function oklch(lightness: number, chroma: number, hue: number): string {
  return `rgb(${oklch_rgb(lightness, chroma, hue).join(',')})`;
}

/// Small is close to the background, large stands out from it.
export function ramp(t: number, dark: boolean): string {
  const u = Math.min(1, Math.max(0, t));
  return dark ? oklch(0.56 + 0.36 * u, 0.12 + 0.02 * u, 285 - 180 * u)
              : oklch(0.80 - 0.46 * u, 0.12 + 0.05 * u, 165 + 150 * u);
}

export interface Theme {
  dark: boolean;
  get(name: string): string; // a custom property of the style sheet
}

export function current_theme(): Theme {
  const style = getComputedStyle(document.documentElement);
  const known = new Map<string, string>();
  return {
    dark: style.getPropertyValue('--dark').trim() === '1',
    get(name) {
      let value = known.get(name);
      if (value === undefined) known.set(name, value = style.getPropertyValue('--' + name).trim());
      return value;
    },
  };
}

const kSeriesColors = 7;

/// Okabe and Ito's (2008) order, told apart by the colour blind; used for the series of plots and
/// for vehicles.
export function series_name(index: number): string {
  return `series-${index % kSeriesColors}`;
}
export function series_color(index: number, theme: Theme): string {
  return theme.get(series_name(index));
}

/// Vehicles differ in their dashes too [px].
export const kFleetDashes: number[][] = [[], [9, 4], [3, 3], [12, 4, 3, 4], [6, 2]];
