/** Text for students → what to show: paragraphs, lists, emphasis, formulas. Pure, and it makes no HTML:
 * whatever else stands in the text is shown as it is written. */

export type Inline =
  | { kind: 'text' | 'strong' | 'emphasis'; text: string }
  | { kind: 'formula'; tex: string };

export type Block =
  | { kind: 'paragraph'; content: Inline[] }
  | { kind: 'list'; items: Inline[][] }
  | { kind: 'formula'; tex: string };

export function parseText(source: string): Block[] {
  const text = source.replace(/\r\n?/g, '\n');
  const blocks: Block[] = [];
  // Formulas of their own first: what stands between $$ and $$ may hold blank lines and hyphens.
  for (const [i, part] of text.split('$$').entries()) {
    if (i % 2 === 0) blocks.push(...plainBlocks(part));
    else if (part.trim()) blocks.push({ kind: 'formula', tex: part.trim() });
  }
  return blocks;
}

function plainBlocks(text: string): Block[] {
  const blocks: Block[] = [];
  let lines: string[] = [];
  let items: string[] = [];
  const end = () => {
    if (lines.length > 0) blocks.push({ kind: 'paragraph', content: parseInline(lines.join(' ')) });
    if (items.length > 0) blocks.push({ kind: 'list', items: items.map(parseInline) });
    lines = [];
    items = [];
  };
  for (const raw of text.split('\n')) {
    const line = raw.trim();
    if (line === '') end();
    else if (line.startsWith('- ')) {
      if (lines.length > 0) end();
      items.push(line.slice(2).trim());
    } else if (items.length > 0) items.push(`${items.pop()} ${line}`);
    else lines.push(line);
  }
  end();
  return blocks;
}

/** Marks without their partner are text like any other. */
export function parseInline(text: string): Inline[] {
  const found: Inline[] = [];
  const marks = /\$([^$]+)\$|\*\*([^*]+)\*\*|\*([^*\s](?:[^*]*[^*\s])?)\*/g;
  let from = 0;
  for (const match of text.matchAll(marks)) {
    if (match.index > from) found.push({ kind: 'text', text: text.slice(from, match.index) });
    const [whole, tex, strong, emphasis] = match;
    if (tex !== undefined) found.push({ kind: 'formula', tex });
    else if (strong !== undefined) found.push({ kind: 'strong', text: strong });
    else found.push({ kind: 'emphasis', text: emphasis ?? '' });
    from = match.index + whole.length;
  }
  if (from < text.length) found.push({ kind: 'text', text: text.slice(from) });
  return found;
}
