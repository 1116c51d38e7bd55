/** Sets formulas with KaTeX. The only file that knows it; loaded where a formula is shown. */
import katex from 'katex';
import 'katex/dist/katex.min.css';

/** Nodes and not HTML: nothing is parsed, and the content security policy allows it. What cannot be set is shown as it was written. */
export function setFormula(place: HTMLElement, tex: string, display: boolean): void {
  const sheet = document.createElement('span');
  try {
    katex.render(tex, sheet, { displayMode: display, throwOnError: true, trust: false, strict: 'ignore', maxExpand: 200, maxSize: 10 });
    place.replaceChildren(sheet);
  } catch {
    place.textContent = tex;
  }
}
