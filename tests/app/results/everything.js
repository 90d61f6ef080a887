// Clicks, drags, sorts, chooses and types into everything on a report, in turn. The title becomes what failed, and
// what was seen: states behind the slider, curves held beside each other, and limits of a chart that was dragged over.
addEventListener('load', async () => {
  const all = (query) => [...document.querySelectorAll(query)], wait = (ms = 20) => new Promise(done => setTimeout(done, ms));
  const faults = [], told = {};
  addEventListener('error', event => faults.push(event.message));
  addEventListener('unhandledrejection', event => faults.push(String(event.reason)));
  const follow = HTMLAnchorElement.prototype.click;  // a download keeps a browser without a window from ending
  HTMLAnchorElement.prototype.click = function () { if (this.download) told.saved = this.download; else follow.call(this); };
  while (!document.body.dataset.ready) await wait();
  told.charts = all('.chart .plot').length;
  for (const button of all('button')) { button.click(); await wait(); button.click(); await wait(); }
  const slider = document.getElementById('state'), chart = document.getElementById('surface-0');
  if (slider) {
    told.last = Number(slider.max);
    const seen = new Set();
    document.getElementById('clear').click();
    for (let state = 0; state <= told.last; state++) {
      slider.value = state; slider.dispatchEvent(new Event('input')); await wait();
      seen.add(document.getElementById('which').textContent);
    }
    told.states = seen.size;
    slider.value = 0; slider.dispatchEvent(new Event('input'));
    const methods = chart?.data.length;
    document.getElementById('hold').click();
    slider.value = told.last; slider.dispatchEvent(new Event('input')); await wait();
    told.held = chart?.data.length / methods;
  }
  for (const list of all('select')) for (const option of list.options) {
    list.value = option.value; list.dispatchEvent(new Event('change')); await wait();
  }
  for (const field of all('input[type=search]')) for (const text of ['FM1', 'c=0.6', 'nothing of that', '']) {
    field.value = text; field.dispatchEvent(new Event('input')); await wait();
  }
  const mouse = (target, kind, x, y) => target.dispatchEvent(new MouseEvent(kind, { bubbles: true, cancelable: true, clientX: x, clientY: y, button: 0, buttons: 1 }));
  for (const box of all('.chart')) {
    box.scrollIntoView();
    const drag = box.querySelector('.nsewdrag'), { left, top, width, height } = drag.getBoundingClientRect();
    const before = JSON.stringify(box._fullLayout.xaxis.range);
    mouse(drag, 'mousemove', left + width / 2, top + height / 2); await wait();
    mouse(drag, 'mousedown', left + width / 4, top + height / 4);
    for (const target of [document.querySelector('.dragcover') ?? document]) {
      mouse(target, 'mousemove', left + width / 2, top + height / 2); await wait();
      mouse(target, 'mouseup', left + width / 2, top + height / 2); await wait(60);
    }
    const zoomed = JSON.stringify(box._fullLayout.xaxis.range) !== before;
    await Plotly.relayout(box, { 'xaxis.autorange': true, 'yaxis.autorange': true });
    for (const name of box.querySelectorAll('.legendtoggle')) { mouse(name, 'mousedown', 0, 0); mouse(name, 'mouseup', 0, 0); await wait(); }
    if (box === chart) { told.zoomed = zoomed; told['whole again'] = box._fullLayout.xaxis.autorange === true; }
  }
  await wait(400);
  for (const picture of all('figure img')) {
    picture.click(); await wait(); document.getElementById('large').click();
    picture.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter' })); await wait(); document.getElementById('large').click();
  }
  for (const link of all('nav a')) link.click();
  document.title = JSON.stringify([faults, told]);
})
