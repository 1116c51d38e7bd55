import { describe, expect, it } from 'vitest';
import { parseInline, parseText } from '../../src/models/rich_text';

describe('text for students', () => {
  it('has paragraphs, lists and formulas of their own', () => {
    const blocks = parseText('First line\nand second.\n\n- one\n- two\n  goes on\n\nBefore $$\nx = y\n\n- z\n$$ after');
    expect(blocks).toEqual([
      { kind: 'paragraph', content: [{ kind: 'text', text: 'First line and second.' }] },
      { kind: 'list', items: [[{ kind: 'text', text: 'one' }], [{ kind: 'text', text: 'two goes on' }]] },
      { kind: 'paragraph', content: [{ kind: 'text', text: 'Before' }] },
      { kind: 'formula', tex: 'x = y\n\n- z' },
      { kind: 'paragraph', content: [{ kind: 'text', text: 'after' }] },
    ]);
    expect(parseText('')).toEqual([]);
  });

  it('has formulas and emphasis in a line', () => {
    expect(parseInline('A **ball** of $m_1 * r^2$ and *mass* $x$.')).toEqual([
      { kind: 'text', text: 'A ' }, { kind: 'strong', text: 'ball' }, { kind: 'text', text: ' of ' }, { kind: 'formula', tex: 'm_1 * r^2' },
      { kind: 'text', text: ' and ' }, { kind: 'emphasis', text: 'mass' }, { kind: 'text', text: ' ' }, { kind: 'formula', tex: 'x' }, { kind: 'text', text: '.' },
    ]);
  });

  it.each(['3 * 4 * 5', 'costs 5 $', '**open', 'a - b'])('shows marks without their partner as they are: %s', (text) => {
    expect(parseInline(text)).toEqual([{ kind: 'text', text }]);
  });

  it.each(['<script>alert(1)</script>', '<img src=x onerror=alert(1)>', '[here](javascript:alert(1))', '&lt;b&gt;', '![x](y)'])(
    'makes nothing of HTML or links but text: %s',
    (text) => {
      expect(parseText(text)).toEqual([{ kind: 'paragraph', content: [{ kind: 'text', text }] }]);
      expect(parseInline(`**${text}**`)).toEqual([{ kind: 'strong', text }]);
    },
  );
});
