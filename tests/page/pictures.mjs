// SPDX-License-Identifier: Apache-2.0
// pictures.mjs PAGE#SCENARIO@TIMEs PNG HEIGHT: a report page, opened at a scenario and a moment.
import {chromium} from 'playwright-core';

const [address, picture, height] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-angle=swiftshader']});
const page = await browser.newPage({viewport: {width: 1360, height: Number(height)}});
await page.goto('file://' + address);
await page.locator('section:visible .replay canvas').waitFor();
await page.waitForTimeout(2000);
await page.screenshot({path: picture});
await browser.close();
