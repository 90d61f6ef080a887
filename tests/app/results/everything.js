// Clicks, drags, sorts, chooses and types into everything on a report, in turn. The title becomes what failed, and
// what is read in the middle of the chart after each button, after dragging over its left half and a double click.
addEventListener('load', async () => {
  const all = (query) => [...document.querySelectorAll(query)], wait = () => new Promise(done => setTimeout(done, 20));
  const faults = [], told = {};
  addEventListener('error', event => faults.push(event.message));
  addEventListener('unhandledrejection', event => faults.push(String(event.reason)));
  const follow = HTMLAnchorElement.prototype.click;  // a download keeps a browser without a window from ending
  HTMLAnchorElement.prototype.click = function () { if (this.download) told.saved = this.download; else follow.call(this); };
  const svg = document.querySelector('#curves svg');
  const point = (kind, share) => {
    const box = svg.getBoundingClientRect();
    const event = new PointerEvent(kind, { bubbles: true, cancelable: true, clientX: box.left + 58 + share * (box.width - 70) });
    svg.dispatchEvent(event);
  };
  const read = (name) => {
    if (!svg) return;
    point('pointermove', 0.5);
    told[name] = Number(document.querySelector('#curves output').textContent.split(';')[0].split('= ')[1].replace('−', '-'));
  };
  for (const button of all('button')) { button.click(); await wait(); button.click(); await wait(); read(button.id || button.textContent); }
  for (const list of all('select')) for (const option of list.options) {
    list.value = option.value; list.dispatchEvent(new Event('change')); await wait();
    told.drawn = Math.min(told.drawn ?? 9, all('#curves path').filter(path => path.getAttribute('d').length > 20).length);
  }
  for (const field of all('input')) for (const text of ['FM1', 'c=0.6', 'nothing of that', '']) {
    field.value = text; field.dispatchEvent(new Event('input')); await wait();
  }
  if (svg) {
    document.getElementById('all').click();
    point('pointerdown', 0); point('pointermove', 0.25); point('pointerup', 0.5); read('dragged');
    point('pointerdown', 0.5); point('pointerup', 0.5); read('not dragged');
    svg.dispatchEvent(new MouseEvent('dblclick')); read('double click');
  }
  for (const picture of all('figure img')) {
    picture.click(); await wait(); document.getElementById('large').click();
    picture.dispatchEvent(new KeyboardEvent('keydown', { key: 'Enter' })); await wait(); document.getElementById('large').click();
  }
  for (const link of all('nav a')) link.click();
  document.title = JSON.stringify([faults, told]);
})
