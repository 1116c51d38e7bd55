// Experiments in a browser: choose one, see what a run of it came to, analyse it again; write one of one's own.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { startServer } from '../integration/server.mjs';
import { canvasState, inspect, launch, visit } from './browser.mjs';
import { changePassword, mainButton, reach, signIn } from './steps.mjs';

const adminPassword = 'swing low sweet chariot';
const instructorPassword = 'a lever long enough';
const studentPassword = 'an arc of ten degrees';

const endings = [];
const lifetime = { after: (end) => endings.unshift(end) };
const findings = [];
let server;
let browser;
let admin;
let instructor;
let student;

before(async () => {
  server = await startServer(lifetime, { rigs: 1 });
  browser = await launch();
  lifetime.after(() => browser.close());
  admin = await visit(browser, server.url);
  await admin.page.goto('/people');
  await enter(admin, 'admin', server.password, adminPassword);
  await admin.page.getByRole('heading', { name: 'People', level: 1 }).waitFor();
  instructor = await person('emmy', 'Emmy Noether', 'Instructor', instructorPassword);
  student = await person('ada', 'Ada Lovelace', 'Student', studentPassword);
});

after(async () => {
  for (const end of endings) await end();
});

async function enter({ page }, username, oneTimePassword, password) {
  await signIn(page, username, oneTimePassword);
  await page.getByRole('heading', { name: 'Choose your own password' }).waitFor();
  await changePassword(page, oneTimePassword, password);
  await page.getByRole('heading', { name: 'Choose your own password' }).waitFor({ state: 'detached' });
}

/** Adds somebody and signs them in, in a window of their own. */
async function person(username, name, role, password) {
  const { page } = admin;
  await page.getByLabel('User name').fill(username);
  await page.getByLabel('Name', { exact: true }).fill(name);
  await page.getByLabel('Role').selectOption({ label: role });
  await page.getByRole('button', { name: 'Add', exact: true }).click();
  await page.locator('.once', { hasText: username }).waitFor();
  const oneTimePassword = await page.locator('code').innerText();
  const visitor = await visit(browser, server.url);
  await visitor.page.goto('/');
  await enter(visitor, username, oneTimePassword, password);
  return visitor;
}

const chart = (page, name) => page.locator(`[data-plot="${name}"]`);
const edited = (page, label) => page.getByLabel(label, { exact: true });

test('the catalogue leads to theory with formulas, settings and a rig', async () => {
  const { page } = student;
  await page.getByRole('link', { name: 'Experiments', exact: true }).click();
  await page.getByRole('link', { name: 'Simple pendulum' }).waitFor();
  findings.push(...(await inspect(page, '20-experiments')));
  await page.getByRole('link', { name: 'Simple pendulum' }).click();
  await page.getByRole('heading', { name: 'Simple pendulum', level: 1 }).waitFor();
  await page.locator('.katex').nth(5).waitFor();
  const formula = page.locator('.katex-display .katex-html').first();
  assert.ok((await formula.boundingBox()).height > 20, 'the formula is set');
  assert.match(await formula.evaluate((e) => getComputedStyle(e.querySelector('.mord')).fontFamily), /KaTeX/);
  await page.getByRole('heading', { name: 'What a good run looks like' }).waitFor();
  await page.getByRole('rowheader', { name: /^Starting angle/ }).waitFor();
  assert.equal(await page.getByRole('link', { name: 'Copy' }).count(), 0, 'students write no experiments');
  await page.getByRole('link', { name: /^Book it/ }).waitFor();
  findings.push(...(await inspect(page, '21-experiment')));
});

test('a run of it shows its plots and its checks', async () => {
  const { page } = student;
  await page.getByRole('link', { name: /^Book it/ }).first().click();
  await page.getByRole('button', { name: 'Book this slot' }).click();
  await page.getByRole('link', { name: 'Join now' }).click();
  await mainButton(page, 'prepare').waitFor();
  // Too short for ten periods: a result, but no good run.
  await page.getByLabel('How long to measure').fill('14');
  await mainButton(page, 'prepare').click();
  await reach(page, 'release');
  await mainButton(page, 'release').click();
  await reach(page, 'result', 120_000);
  findings.push(...(await inspect(page, '22-session')));
  await mainButton(page, 'result').click();
  await page.getByTestId('first-result').waitFor();
  await page.getByText('This is not a good run.').waitFor();
  const missed = page.locator('[data-check="periods"]');
  assert.match(await missed.innerText(), /Measure for longer/);
  assert.doesNotMatch(await page.locator('[data-check="tracked_share"]').innerText(), /See that nothing/);
  assert.ok((await page.locator('[data-result]').count()) >= 5, 'all results stand in the table');
  for (const name of ['position', 'residuals', 'phase', 'path']) {
    await chart(page, name).scrollIntoViewIfNeeded();
    const { contrast } = await canvasState(page, `[data-plot="${name}"] canvas`);
    assert.ok(contrast > 40, `${name} is drawn: contrast ${contrast}`);
  }
  findings.push(...(await inspect(page, '23-run')));
});

test('a plot tells values, zooms where one drags, and shows all again', async () => {
  const { page } = student;
  const canvas = chart(page, 'position').locator('canvas');
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  const at = (right, down) => [box.x + box.width * right, box.y + box.height * down];
  // Somewhere along the middle there is a point within reach.
  for (let right = 0.3; right < 0.7; right += 0.02) {
    await page.mouse.move(...at(right, 0.45));
    if (await chart(page, 'position').locator('output').count()) break;
  }
  assert.match(await chart(page, 'position').locator('output').innerText(), /t = .*s, .* = .*m/);
  const whole = (await canvasState(page, '[data-plot="position"] canvas')).hash;
  await page.mouse.move(...at(0.4, 0.5));
  await page.mouse.down();
  await page.mouse.move(...at(0.6, 0.52), { steps: 4 });
  await page.mouse.up();
  await page.locator('[data-plot="position"][data-zoomed="true"]').waitFor();
  await page.mouse.move(box.x, box.y - 40);
  assert.notEqual((await canvasState(page, '[data-plot="position"] canvas')).hash, whole);
  await canvas.dblclick({ position: { x: box.width / 2, y: box.height / 2 } });
  await page.locator('[data-plot="position"][data-zoomed="false"]').waitFor();
  await canvas.focus();
  await page.keyboard.press('+');
  await page.locator('[data-plot="position"][data-zoomed="true"]').waitFor();
  await page.keyboard.press('0');
  await page.locator('[data-plot="position"][data-zoomed="false"]').waitFor();
});

test('the same plots can be taken along, and a report printed', async () => {
  const { page } = student;
  const sizes = await page.evaluate(async () => {
    const links = [...document.querySelectorAll('a[href*="/plots/"], a[href*="/report"], a[href$=".csv"]')].map((a) => a.href);
    const answers = await Promise.all(links.map(async (href) => ({ href, answer: await fetch(href) })));
    return Promise.all(answers.map(async ({ href, answer }) => ({ href, status: answer.status, size: (await answer.arrayBuffer()).byteLength })));
  });
  assert.ok(sizes.length >= 10, JSON.stringify(sizes));
  for (const { href, status, size } of sizes) assert.ok(status === 200 && size > 500, `${href}: ${status}, ${size} bytes`);
});

test('analysing it again adds a version beside the first', async () => {
  const { page } = student;
  const before_ = await page.getByTestId('first-result').innerText();
  await page.getByRole('button', { name: 'Analyse again' }).click();
  const length = page.getByRole('dialog').getByLabel(/^Length/);
  await length.waitFor();
  assert.notEqual(await length.inputValue(), '');
  await length.fill('much');
  await page.getByRole('button', { name: 'Analyse', exact: true }).click();
  await page.locator('#setting-length_m-error').waitFor();
  findings.push(...(await inspect(page, '24-analyse-again')));
  await length.fill('1.1');
  await page.getByRole('button', { name: 'Analyse', exact: true }).click();
  await page.getByText('Version 2 is there and is shown now.').waitFor();
  assert.notEqual(await page.getByTestId('first-result').innerText(), before_);
  assert.equal(await page.getByRole('radio', { name: /^Version/ }).count(), 2);
  await page.getByRole('radio', { name: /^Version 1/ }).check();
  await page.getByText('You see version 1; version 2 is the newest.').waitFor();
  assert.equal(await page.getByTestId('first-result').innerText(), before_);
  findings.push(...(await inspect(page, '25-version-1')));
});

test('an instructor copies an experiment, is told what is wrong and where, and mends it', async () => {
  const { page } = instructor;
  await page.goto('/experiments/pendulum');
  await page.getByRole('link', { name: 'Copy' }).click();
  await edited(page, 'Title').fill('Pendulum on the Moon');
  await page.getByLabel('Short name').fill('moon');
  await page.getByTestId('check').getByText('Nothing is wrong with it.').waitFor();
  await edited(page, 'Theory').fill('On the Moon $g = 1.62$ m/s².\n\n$$T = 2\\pi\\sqrt{L/g}$$\n\n<script>alert(1)</script>');
  await page.getByTestId('check').getByText('Theory').waitFor();
  assert.match(await page.getByTestId('check').innerText(), /looks like HTML/);
  await page.getByTestId('preview').locator('.katex').nth(1).waitFor();
  assert.equal(await page.getByTestId('preview').locator('script').count(), 0);
  assert.match(await page.getByTestId('preview').innerText(), /<script>alert/);
  findings.push(...(await inspect(page, '26-editor-wrong')));
  await page.getByRole('button', { name: 'Show me' }).click();
  assert.equal(await page.evaluate(() => document.activeElement.id), 'part-theory');
  await edited(page, 'Theory').fill('On the Moon $g = 1.62$ m/s².\n\n$$T = 2\\pi\\sqrt{L/g}$$');
  await page.getByTestId('check').getByText('Nothing is wrong with it.').waitFor();

  await edited(page, 'Sequence as JSON').fill('[{"do": "jump"}]');
  await page.getByTestId('check').getByText(/^Sequence, row 1/).waitFor();
  await edited(page, 'Sequence as JSON').fill('[{"do": "stop"},');
  await page.getByTestId('check').getByText(/no JSON: see line 1/).waitFor();
  await edited(page, 'Sequence as JSON').fill('[{"do": "stop"}, {"do": "wait", "seconds": 1, "learn": true}, {"do": "displace", "to": {"parameter": "amplitude_deg"}}]');
  await page.getByTestId('check').getByText('Nothing is wrong with it.').waitFor();
  await page.getByRole('button', { name: 'Save as a draft' }).click();
  await page.getByRole('heading', { name: 'Pendulum on the Moon', level: 1 }).waitFor();
  await student.page.goto('/experiments');
  await student.page.getByRole('link', { name: 'Simple pendulum' }).waitFor();
  assert.equal(await student.page.getByRole('link', { name: 'Pendulum on the Moon' }).count(), 0, 'drafts are not for students');
});

test('tries it on a stored run and publishes it; a student sees it', async () => {
  const { page } = instructor;
  await page.getByTestId('check').getByText('Nothing is wrong with it.').waitFor();
  await page.getByRole('button', { name: 'Try it' }).click();
  await page.getByTestId('tried').getByTestId('first-result').waitFor();
  await page.getByTestId('tried').locator('[data-plot="position"]').waitFor();
  findings.push(...(await inspect(page, '27-editor-tried')));
  await page.getByRole('button', { name: 'Publish' }).click();
  await page.getByText('Published: students can choose it now.').waitFor();

  await student.page.goto('/experiments');
  await student.page.getByRole('link', { name: 'Pendulum on the Moon' }).click();
  await student.page.getByRole('heading', { name: 'Pendulum on the Moon', level: 1 }).waitFor();
  await student.page.getByText('Written by Emmy Noether').waitFor();
  await student.page.locator('.katex').nth(1).waitFor();
});

test('a retired experiment is no longer offered', async () => {
  const { page } = instructor;
  await page.getByRole('button', { name: 'Retire' }).click();
  await page.getByRole('button', { name: 'Retire it' }).click();
  await page.getByTestId('own').getByText('Retired').waitFor();
  findings.push(...(await inspect(page, '28-experiments-instructor')));
  await student.page.goto('/experiments');
  await student.page.getByRole('link', { name: 'Simple pendulum' }).waitFor();
  assert.equal(await student.page.getByRole('link', { name: 'Pendulum on the Moon' }).count(), 0);
});

test('no page had a serious finding of axe, was wider than its window, or logged an error', () => {
  assert.deepEqual(findings, []);
  for (const visitor of [admin, instructor, student]) assert.deepEqual(visitor.errors, []);
});
