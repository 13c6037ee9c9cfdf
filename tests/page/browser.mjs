// SPDX-License-Identifier: Apache-2.0
// Chromium and the program, for the tests of pages.
import {spawnSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {after, before} from 'node:test';
import {chromium} from 'playwright-core';

const {PREHEND, PROJECT} = process.env;
const axe = readFileSync('node_modules/axe-core/axe.min.js', 'utf8');

/// What the program prints, called in the project.
export function prehend(...words) {
  return spawnSync(PREHEND, words, {cwd: PROJECT, encoding: 'utf8', maxBuffer: 1 << 28}).stdout;
}

let browser;
before(async () => {
  browser = await chromium.launch({
    executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-angle=swiftshader']});
});
after(() => browser && browser.close());

/// A page, and what it asked for and complained about.
export async function openPage({hash = '', file, ...options}) {
  const context = await browser.newContext({viewport: {width: 1280, height: 900}, ...options});
  const page = await context.newPage();
  const seen = {requests: [], complaints: []};
  page.on('request', (request) => {
    if (!request.url().startsWith('data:')) seen.requests.push(request.url());
  });
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) seen.complaints.push(message.text());
  });
  page.on('pageerror', (error) => seen.complaints.push(String(error)));
  const session = await context.newCDPSession(page);
  await session.send('Performance.enable', {timeDomain: 'threadTicks'});
  await page.goto('file://' + file + hash);
  /// Processor time of the page's main thread, whatever else this machine does.
  const busy_s = async () => (await session.send('Performance.getMetrics')).metrics.find((each) => each.name === 'TaskDuration').value;
  return {page, seen, busy_s, close: () => context.close()};
}

/// What axe-core calls serious or critical, a line each.
export async function serious(page) {
  await page.evaluate(axe);
  const result = await page.evaluate(() => window.axe.run());
  return result.violations.filter((each) => ['serious', 'critical'].includes(each.impact))
    .flatMap((each) => each.nodes.map((node) => `${each.id}: ${node.html.slice(0, 120)} ${node.failureSummary}`));
}
