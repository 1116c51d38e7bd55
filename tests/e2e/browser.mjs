// Debian's Chromium, driven by playwright-core; a picture and an accessibility check of a page.
import { mkdir, readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const artefacts = fileURLToPath(new URL('../artefacts/', import.meta.url));
const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

const flags = [
  '--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync',
  // WebGL in software: the machines that run this have no graphics card.
  '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
];

export function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: flags });
}

/** A fresh visitor in a zone that is not UTC; whatever the page logs as an error ends up in `errors`. */
export async function visit(browser, url) {
  const context = await browser.newContext({ baseURL: url, viewport: { width: 1280, height: 800 }, timezoneId: 'Europe/Berlin', locale: 'en-GB' });
  const page = await context.newPage();
  // A loaded machine draws a page in many seconds; waiting longer costs nothing where all is well.
  page.setDefaultTimeout(60_000);
  const errors = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => {
    // A refused request is logged by the browser itself; refusals are part of what is tested.
    if (message.type() === 'error' && !message.text().startsWith('Failed to load resource')) errors.push(message.text());
  });
  return { context, page, errors };
}

const looks = [
  { name: '1280-light', viewport: { width: 1280, height: 800 }, colorScheme: 'light' },
  { name: '360-dark', viewport: { width: 360, height: 740 }, colorScheme: 'dark' },
];

/** Takes the page's picture wide and light, narrow and dark; returns what is wrong with it in either:
 * serious findings of axe, and content that is wider than the window. */
export async function inspect(page, name) {
  await mkdir(artefacts, { recursive: true });
  const findings = [];
  for (const look of looks) {
    await page.setViewportSize(look.viewport);
    await page.emulateMedia({ colorScheme: look.colorScheme });
    await settled(page);
    await page.screenshot({ path: `${artefacts}${name}-${look.name}.png`, fullPage: true });
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    if (width > look.viewport.width) findings.push(`${name} ${look.name}: ${width} px wide`);
    findings.push(...(await seriousFindings(page)).map((finding) => `${name} ${look.name}: ${finding}`));
  }
  await page.setViewportSize(looks[0].viewport);
  await page.emulateMedia({ colorScheme: 'light' });
  return findings;
}

/** Three drawn frames: what depends on the window's size has been drawn for it. */
function settled(page) {
  return page.evaluate(async () => {
    for (let i = 0; i < 3; i++) await new Promise((next) => requestAnimationFrame(next));
  });
}

async function seriousFindings(page) {
  await page.evaluate(`if (!window.axe) { ${axe} }`);
  const violations = await page.evaluate(async () => (await window.axe.run()).violations);
  return violations
    .filter((v) => v.impact === 'serious' || v.impact === 'critical')
    .map((v) => `${v.impact} ${v.id} at ${v.nodes.map((n) => n.target.join(' ')).join(', ')}`);
}

/** A number that changes with the picture on a canvas, and whether there is a picture at all. */
export function canvasState(page, selector) {
  return page.locator(selector).evaluate((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    let hash = 0;
    let darkest = 255;
    let brightest = 0;
    for (let i = 0; i < data.length; i += 4) {
      hash = (hash * 31 + data[i]) | 0;
      darkest = Math.min(darkest, data[i]);
      brightest = Math.max(brightest, data[i]);
    }
    return { hash, contrast: brightest - darkest };
  });
}
