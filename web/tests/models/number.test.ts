import { describe, expect, it } from 'vitest';
import { decimalsFor, formatQuantity, formatUncertain, parseDecimal, unitText } from '../../src/models/number';

const thin = '\u202f';
const show = (value: number, u: number, unit = 'm/s²') => formatUncertain(value, u, unit, 'en').text.replaceAll(thin, ' ');

describe('a value with its uncertainty', () => {
  it('has the uncertainty with two digits and the value to the same place', () => {
    expect(show(9.808704, 0.000716)).toBe('9.80870 ± 0.00072 m/s²');
    expect(show(9.80665, 0.0123)).toBe('9.807 ± 0.012 m/s²');
    expect(show(2.00984, 0.00012, 's')).toBe('2.00984 ± 0.00012 s');
    expect(show(1234.5, 12.3, 'm')).toBe('1235 ± 12 m');
    expect(show(5, 1.26, '°')).toBe('5.0 ± 1.3 °');
  });

  it('keeps two digits when rounding carries into the next place', () => {
    expect(show(1, 0.0996, 'm')).toBe('1.00 ± 0.10 m');
    expect(show(9.8, 0.00999, 'm')).toBe('9.800 ± 0.010 m');
    expect(show(100, 9.96, 'm')).toBe('100 ± 10 m');
  });

  it('rounds large uncertainties too, and never groups digits', () => {
    expect(show(123456, 1234, 'm')).toBe('123456 ± 1200 m');
  });

  it('writes a true minus and the decimal sign of the locale', () => {
    expect(show(-0.01, 0.0012, 'm')).toBe('\u22120.0100 ± 0.0012 m');
    expect(formatUncertain(9.8087, 0.0071, 'm/s²', 'de').text).toBe(`9,8087${thin}±${thin}0,0071${thin}m/s²`);
  });

  it('shows a value without uncertainty alone, and no number at all as a dash', () => {
    expect(show(9.80665, 0)).toBe('9.8067 m/s²');
    expect(show(9.80665, NaN)).toBe('9.8067 m/s²');
    expect(show(NaN, 0.1)).toBe('–');
  });

  it('knows the decimals at powers of ten', () => {
    expect([0.001, 0.01, 0.1, 1, 10, 100].map(decimalsFor)).toEqual([4, 3, 2, 1, 0, 0]);
  });
});

it('writes units as printed', () => {
  expect(['m/s^2', 'm/s2', 'm/s²', '1', 'deg', 's^-1', 's'].map(unitText)).toEqual(['m/s²', 'm/s²', 'm/s²', '', '°', 's⁻¹', 's']);
});

it('writes a setting without trailing zeros', () => {
  expect(formatQuantity(1, 'm', 4, 'en')).toBe(`1${thin}m`);
  expect(formatQuantity(0.0005, 'm', 4, 'en')).toBe(`0.0005${thin}m`);
  expect(formatQuantity(-90, '°', 4, 'en')).toBe(`\u221290${thin}°`);
});

describe('what somebody typed', () => {
  it('may have a comma or a point', () => {
    expect(parseDecimal('1.25')).toBe(1.25);
    expect(parseDecimal(' 1,25 ')).toBe(1.25);
    expect(parseDecimal('\u22125')).toBe(-5);
    expect(parseDecimal('.5')).toBe(0.5);
    expect(parseDecimal('1e-3')).toBe(0.001);
  });

  it.each(['', ' ', 'abc', '1.2.3', '1,000.5', '1 m', '0x10', 'Infinity', '--1', ','])('is no number: “%s”', (text) => {
    expect(parseDecimal(text)).toBeNaN();
  });
});
