// SPDX-License-Identifier: Apache-2.0
// pictures.mjs PAGE PNG: the failed test of README.md on the report page, with its replay and the deciding signal.
import {chromium} from 'playwright-core';

const [file, picture] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-angle=swiftshader']});
const page = await browser.newPage({viewport: {width: 1360, height: 800}});
await page.goto('file://' + file + '#slide/four_centimetres_are_a_slide@1.9000s');
await page.locator('section:visible .replay canvas').waitFor();
await page.waitForTimeout(2000);
await page.screenshot({path: picture});
await browser.close();
