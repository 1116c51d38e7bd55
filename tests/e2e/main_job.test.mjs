// The main job in a browser, end to end: sign in, book, release, watch, read g; and again from the list.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { startServer } from '../integration/server.mjs';
import { canvasState, inspect, launch, visit } from './browser.mjs';
import { openDoor } from './door.mjs';
import { changePassword, mainButton, reach, readMeasurement, signIn, stateSentence, tabTo } from './steps.mjs';

const adminPassword = 'swing low sweet chariot';
const studentPassword = 'an arc of ten degrees';
const measured_s = 20;

const endings = [];
const lifetime = { after: (end) => endings.unshift(end) };
let server;
let door;
let browser;
let admin;
let oneTimePassword;
let shownG;
const findings = [];

before(async () => {
  server = await startServer(lifetime, { rigs: 2 });
  door = await openDoor(server.port);
  lifetime.after(door.close);
  browser = await launch();
  lifetime.after(() => browser.close());
  admin = await visit(browser, door.url);
});

after(async () => {
  for (const end of endings) await end();
});

test('a deep link leads through sign-in and a password of one’s own to the page it names', async () => {
  const { page } = admin;
  await page.goto('/runs');
  await signIn(page, 'admin', 'not the password');
  await page.getByRole('alert').waitFor();
  findings.push(...(await inspect(page, '01-sign-in')));
  await signIn(page, 'admin', server.password);
  await page.getByRole('heading', { name: 'Choose your own password' }).waitFor();
  findings.push(...(await inspect(page, '02-password')));
  await changePassword(page, server.password, 'short');
  await page.locator('#new-error').waitFor();
  await changePassword(page, server.password, adminPassword);
  await page.getByRole('heading', { name: 'Runs', level: 1 }).waitFor();
  await page.getByText('There are no runs yet').waitFor();
  assert.equal(await page.title(), 'Runs – Kinectlab');
  findings.push(...(await inspect(page, '03-runs-empty')));
});

test('the slot that is running can be booked with two clicks from the rigs', async () => {
  const { page } = admin;
  await page.getByRole('link', { name: 'Home', exact: true }).click();
  await page.getByText('You have no session booked').waitFor();
  findings.push(...(await inspect(page, '04-home-empty')));
  await page.getByRole('link', { name: 'Rigs' }).click();
  await page.locator('.tile img').first().waitFor();
  assert.equal(await page.evaluate(() => document.activeElement?.tagName), 'H1', 'the focus is at the new page’s heading');
  findings.push(...(await inspect(page, '05-rigs')));
  await page.getByRole('link', { name: /^Book a slot on/ }).first().click();
  await page.getByText('Europe/Berlin').first().waitFor();
  await page.getByRole('button', { name: 'Book this slot' }).waitFor();
  findings.push(...(await inspect(page, '06-booking')));
  await page.getByRole('button', { name: 'Book this slot' }).click();
  await page.getByRole('link', { name: 'Join now' }).waitFor();
  findings.push(...(await inspect(page, '07-booked')));
});

test('a wrong setting is told at its field and nothing starts', async () => {
  const { page } = admin;
  await page.goto('/');
  await page.getByRole('heading', { name: 'It is your turn' }).waitFor();
  findings.push(...(await inspect(page, '08-home-slot')));
  await page.getByRole('link', { name: 'Join the session' }).click();
  await mainButton(page, 'prepare').waitFor();
  await page.getByLabel('How long to measure').fill('1');
  await mainButton(page, 'prepare').click();
  await page.locator('#parameter-duration_s-error').waitFor();
  assert.equal(await page.evaluate(() => document.activeElement?.id), 'parameter-duration_s');
  assert.ok(await mainButton(page, 'prepare').isVisible());
});

test('the camera picture is there and moves, the run is prepared and released', async () => {
  const { page } = admin;
  const camera = 'canvas[aria-label^="Live picture"]';
  await page.getByLabel('How long to measure').fill(String(measured_s));
  await page.getByText('The picture is on its way').waitFor({ state: 'detached' });
  findings.push(...(await inspect(page, '09-session')));
  await mainButton(page, 'prepare').click();
  await reach(page, 'release');
  assert.match(await stateSentence(page), /The bob is held/);
  const still = await canvasState(page, camera);
  assert.ok(still.contrast > 60, `a picture and not a plain area: contrast ${still.contrast}`);
  await mainButton(page, 'release').click();
  await reach(page, 'stop');
  assert.match(await stateSentence(page), /The bob moves/);
  await page.waitForFunction(
    ([selector, hash]) => {
      const canvas = document.querySelector(selector);
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let now = 0;
      for (let i = 0; i < data.length; i += 4) now = (now * 31 + data[i]) | 0;
      return now !== hash;
    },
    [camera, still.hash],
  );
  await page.getByText(/^([5-9]|1\d) of 20/).waitFor();
  findings.push(...(await inspect(page, '10-measuring')));
});

test('g appears with its uncertainty, as the interface says it', async () => {
  const { page } = admin;
  await reach(page, 'result', 60_000);
  await mainButton(page, 'result').click();
  await page.getByRole('heading', { name: /^Run \d+/ }).waitFor();
  await page.locator('[data-plot="position"] canvas').waitFor();
  shownG = await page.getByTestId('first-result').innerText();
  const shown = readMeasurement(shownG);
  const run = await page.evaluate(async () => (await fetch(`/api/v1${location.pathname}`)).json());
  const g = run.result.results.find((m) => m.name === 'g');
  assert.ok(Math.abs(shown.value - g.value) <= 0.51 * 10 ** -shown.decimals, `${shownG} for ${g.value}`);
  assert.ok(Math.abs(shown.u - g.u) <= 0.06 * g.u, `${shownG} for ± ${g.u}`);
  assert.ok(Math.abs(g.value - run.parameters.gravity) < 4 * g.u, `${g.value} ± ${g.u} for ${run.parameters.gravity}`);
  findings.push(...(await inspect(page, '11-run')));
});

test('the list of runs opens it again', async () => {
  const { page } = admin;
  await page.getByRole('link', { name: 'Runs' }).first().click();
  await page.getByRole('row').nth(1).waitFor();
  findings.push(...(await inspect(page, '12-runs')));
  await page.getByRole('link', { name: /^Open run/i }).first().click();
  await page.getByTestId('first-result').waitFor();
  assert.equal(await page.getByTestId('first-result').innerText(), shownG);
  await page.goBack();
  await page.getByRole('heading', { name: 'Runs', level: 1 }).waitFor();
});

test('an administrator adds a student, and sees the one-time password once', async () => {
  const { page } = admin;
  await page.getByRole('link', { name: 'People' }).click();
  await page.getByLabel('User name').fill('ada');
  await page.getByLabel('Name', { exact: true }).fill('Ada Lovelace');
  await page.getByRole('button', { name: 'Add', exact: true }).click();
  oneTimePassword = await page.locator('code').innerText();
  assert.ok(oneTimePassword.length >= 8);
  await page.getByRole('cell', { name: 'Ada Lovelace' }).waitFor();
  findings.push(...(await inspect(page, '13-people')));
  await page.reload();
  await page.getByRole('cell', { name: 'Ada Lovelace' }).waitFor();
  assert.equal(await page.locator('code').count(), 0);
});

test('a student does all of it by keyboard alone', async () => {
  const { page, context, errors } = await visit(browser, door.url);
  const { keyboard } = page;
  await page.goto('/');
  await tabTo(page, page.getByLabel('User name'));
  await keyboard.type('ada');
  await tabTo(page, page.getByLabel('Password', { exact: true }));
  await keyboard.type(oneTimePassword);
  await keyboard.press('Enter');
  const given = page.getByLabel('The password you were given');
  await given.waitFor();
  for (const [field, text] of [
    [given, oneTimePassword],
    [page.getByLabel('New password', { exact: true }), studentPassword],
    [page.getByLabel('New password once more'), studentPassword],
  ]) {
    await tabTo(page, field);
    await keyboard.type(text);
  }
  await keyboard.press('Enter');

  await page.getByRole('heading', { name: /^Hello, Ada/ }).waitFor();
  assert.equal(await page.getByRole('link', { name: 'People' }).count(), 0, 'not for students');
  const book = page.getByRole('link', { name: /^Book a slot on/ }).nth(1);
  await book.waitFor();
  await tabTo(page, book);
  await keyboard.press('Enter');

  // The calendar is one stop; the arrows walk in it, and Enter chooses.
  const cell = page.locator('.cell[tabindex="0"]');
  await cell.waitFor();
  await tabTo(page, cell);
  const here = await page.evaluate(() => document.activeElement.getAttribute('aria-label'));
  await keyboard.press('ArrowRight');
  assert.notEqual(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), here);
  await keyboard.press('Enter');
  await page.getByText(/^tomorrow, /).waitFor();
  await keyboard.press('ArrowLeft');
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), here);
  await keyboard.press('Enter');
  const confirm = page.getByRole('button', { name: 'Book this slot' });
  await tabTo(page, confirm);
  await keyboard.press('Enter');
  const join = page.getByRole('link', { name: 'Join now' });
  await join.waitFor();
  await page.keyboard.press('Shift+Tab');
  await tabTo(page, join, 120);
  await keyboard.press('Enter');

  const duration = page.getByLabel('How long to measure');
  await duration.waitFor();
  await tabTo(page, duration);
  await keyboard.press('ControlOrMeta+a');
  await keyboard.type(String(measured_s));
  const main = page.locator('button[data-action]');
  await mainButton(page, 'prepare').waitFor();
  await tabTo(page, main);
  await keyboard.press('Enter');
  for (const [action, key] of [['release', 'Enter'], ['stop', null], ['result', 'Enter']]) {
    await reach(page, action, 60_000);
    assert.ok(await main.evaluate((e) => e === document.activeElement), `the focus stays on the button that now says ${action}`);
    if (key) await keyboard.press(key);
  }
  await page.getByTestId('first-result').waitFor();
  assert.deepEqual(errors, []);
  await context.close();
});

test('a run that ends while the connection is gone is there when it is back', async () => {
  const { page, context } = admin;
  await page.goto('/rigs/rig-1/session');
  await page.getByRole('button', { name: 'Measure again' }).click();
  await page.getByLabel('How long to measure').fill('10');
  await mainButton(page, 'prepare').click();
  await reach(page, 'release');
  await mainButton(page, 'release').click();
  await reach(page, 'stop');
  await context.setOffline(true);
  await page.getByText('You see what was last known of the rig.').waitFor();
  await mainButton(page, 'stop').click();
  const refusal = page.getByText('The laboratory does not answer.');
  await refusal.waitFor();
  await new Promise((later) => setTimeout(later, 14_000));
  await context.setOffline(false);
  await reach(page, 'result');
  await refusal.waitFor({ state: 'detached' });
  assert.match(await stateSentence(page), /The result is there/);
  await page.getByTestId('first-result').waitFor();
});

test('a lost connection is said and heals by itself, over the network and over a restart', async () => {
  const { page, context } = admin;
  await page.goto('/rigs');
  await page.getByRole('link', { name: /^Watch/ }).first().click();
  await page.getByText('Live', { exact: true }).waitFor();
  const lost = page.getByText('The connection is lost.');
  const back = page.getByText('The connection is back.');

  await context.setOffline(true);
  await lost.waitFor();
  findings.push(...(await inspect(page, '14-connection-lost')));
  await context.setOffline(false);
  await back.waitFor();
  await page.getByText('Live', { exact: true }).waitFor();

  await server.end('SIGTERM');
  await lost.waitFor();
  server = await startServer(lifetime, { rigs: 2, data: server.data });
  door.port = server.port;
  await back.waitFor({ timeout: 30_000 });
  await page.getByText('Live', { exact: true }).waitFor();
});

test('what is not there is said plainly', async () => {
  const { page } = admin;
  await page.goto('/nowhere');
  await page.getByRole('heading', { name: 'There is no such page' }).waitFor();
  findings.push(...(await inspect(page, '15-missing')));
  await page.goto('/runs/999999');
  await page.getByRole('alert').waitFor();
  await page.goto('/rigs/no-such-rig/session');
  await page.getByRole('alert').waitFor();
});

test('no page had a serious finding of axe, was wider than its window, or logged an error', () => {
  assert.deepEqual(findings, []);
  assert.deepEqual(admin.errors, []);
});
