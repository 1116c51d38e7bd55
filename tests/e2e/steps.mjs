// What a person does on the pages, step by step.
export async function signIn(page, username, password) {
  await page.getByLabel('User name').fill(username);
  await page.getByLabel('Password', { exact: true }).fill(password);
  await page.getByRole('button', { name: 'Sign in' }).click();
}

export async function changePassword(page, current, next) {
  await page.getByLabel('The password you were given').fill(current);
  await page.getByLabel('New password', { exact: true }).fill(next);
  await page.getByLabel('New password once more').fill(next);
  await page.getByRole('button', { name: 'Change password' }).click();
}

/** The main button says what it does in this state of the run. */
export function mainButton(page, action) {
  return page.locator(`button[data-action="${action}"]:not([aria-disabled])`);
}

/** Waits until the main button offers the action; if it never does, says what the page said instead. */
export async function reach(page, action, timeout = 90_000) {
  await mainButton(page, action).waitFor({ timeout }).catch(async (error) => {
    throw new Error(`the main button never said ${action}; the page said: ${await stateSentence(page)}`, { cause: error });
  });
}

export function stateSentence(page) {
  return page.getByTestId('state').innerText();
}

/** Tab until the element has the focus; fails if it cannot be reached. */
export async function tabTo(page, locator, most = 60) {
  const element = await locator.elementHandle();
  for (let i = 0; i < most; i++) {
    if (await element.evaluate((e) => e === document.activeElement)) return;
    await page.keyboard.press('Tab');
  }
  throw new Error(`not reached with ${most} times Tab: ${locator}`);
}

/** `9.8087 ± 0.0071 m/s²` as it stands on the page. */
export function readMeasurement(text) {
  const match = /([\d.,]+)\s*±\s*([\d.,]+)/.exec(text.replace(/\s+/g, ' '));
  if (!match) throw new Error(`no value ± uncertainty in “${text}”`);
  return { value: Number(match[1].replace(',', '.')), u: Number(match[2].replace(',', '.')), decimals: match[2].split(/[.,]/)[1]?.length ?? 0 };
}
