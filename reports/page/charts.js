'use strict';

// What a chart has to say: the value under the pointer, a posture marked through all figures and tables, a filter, and its
// values as CSV. The marks of a figure (shares of its width and height) stand in the page as JSON; the pictures stay as they are.
(function () {
  const charts = [];
  let filtersTables = false;  // a row of a table is called so, too
  let marked = '';  // the posture that is marked
  let sought = '';  // what is filtered for; empty where nothing is called so

  const element = (name, attributes = {}, text = '') => {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = text;
    return made;
  };
  // The escape characters around names to the letter, and the marks of subscripts, are the page's own.
  const plain = (text) => text.replace(/\u001b/g, '').replace(/_\{([^}]*)\}/g, '$1');
  const same = (a, b) => a.toLowerCase() === b.toLowerCase();

  class Chart {
    constructor(figure, data) {
      this.data = data;
      this.series = data.series.map(plain);
      this.categories = data.categories.map(plain);
      this.figure = figure;
      this.hasPostures = /posture/i.test(data.category);
      this.holder = element('div', { class: 'chart' });
      const picture = figure.querySelector('img');
      picture.before(this.holder);
      this.layer = element('canvas', { class: 'marks', 'aria-hidden': 'true' });
      this.tip = element('div', { class: 'tip', role: 'status' });
      this.tip.hidden = true;
      this.holder.append(picture, this.layer, this.tip);
      this.layer.addEventListener('pointermove', (event) => this.point(event));
      this.layer.addEventListener('pointerleave', () => { this.under = -1; this.tip.hidden = true; this.draw(); });
      this.layer.addEventListener('click', () => this.click());
      this.under = -1;
      const button = element('button', { type: 'button', class: 'csv', title: 'The values of this figure' }, 'CSV');
      button.addEventListener('click', () => this.save());
      figure.querySelector('figcaption').append(' ', button);
    }

    // [x, y, series, category, value, at, quantity]
    words([, , series, category, value, at, of]) {
      const { data } = this;
      const parts = [];
      if (this.series[series]) parts.push(this.series[series]);
      if (category >= 0) parts.push((data.category ? plain(data.category) + ' ' : '') + this.categories[category]);
      else if (data.category) parts.push(plain(data.category) + ': ' + at);
      const quantity = data.quantities[of];
      parts.push((quantity ? plain(quantity) + ': ' : '') + value);
      return parts.join('\n');
    }

    point(event) {
      const box = this.layer.getBoundingClientRect();
      let least = 22;
      this.under = -1;
      this.data.marks.forEach((mark, i) => {
        const away = Math.hypot(mark[0] * box.width - event.clientX + box.left, mark[1] * box.height - event.clientY + box.top);
        if (away < least) [this.under, least] = [i, away];
      });
      this.tip.hidden = this.under < 0;
      if (this.under >= 0) {
        const mark = this.data.marks[this.under];
        this.tip.textContent = this.words(mark);
        const right = mark[0] > 0.6;
        this.tip.style.left = right ? '' : 100 * mark[0] + '%';
        this.tip.style.right = right ? 100 * (1 - mark[0]) + '%' : '';
        // Above a mark of the lower half: a chart that scrolls shows nothing beside itself.
        const low = mark[1] > 0.5;
        this.tip.style.top = low ? '' : 100 * mark[1] + '%';
        this.tip.style.bottom = low ? 100 * (1 - mark[1]) + '%' : '';
      }
      this.draw();
    }

    click() {
      if (this.under < 0 || !this.hasPostures) return;
      const category = this.data.marks[this.under][3];
      if (category >= 0) markPosture(this.categories[category] === marked ? '' : this.categories[category], this);
    }

    fits(mark) {
      if (marked && this.hasPostures && mark[3] >= 0 && this.categories[mark[3]] === marked) return true;
      return sought !== '' && this.isCalled(mark, sought);
    }

    isCalled(mark, name) {
      const names = [this.series[mark[2]] || '', mark[3] >= 0 ? this.categories[mark[3]] : ''];
      return names[1] === name || names[0].split(/[:, ]+/).some((part) => same(part, name));
    }

    draw() {
      const box = this.layer.getBoundingClientRect();
      const ratio = Math.min(2, window.devicePixelRatio || 1);
      this.layer.width = box.width * ratio;
      this.layer.height = box.height * ratio;
      const pen = this.layer.getContext('2d');
      pen.scale(ratio, ratio);
      const ring = (mark, radius, colour, width) => {
        pen.beginPath();
        pen.arc(mark[0] * box.width, mark[1] * box.height, radius, 0, 2 * Math.PI);
        pen.strokeStyle = colour;
        pen.lineWidth = width;
        pen.stroke();
      };
      for (const mark of this.data.marks) if (this.fits(mark)) ring(mark, 7, '#e8a820', 3);
      if (this.under >= 0) ring(this.data.marks[this.under], 8, '#d55000', 2.5);
    }

    save() {
      const field = (text) => (/[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text);
      const lines = ['series,category,at,value,quantity'];
      for (const mark of this.data.marks)
        lines.push([field(this.series[mark[2]] || ''), field(mark[3] >= 0 ? this.categories[mark[3]] : ''), mark[3] >= 0 ? '' : mark[5], mark[4], field(this.data.quantities[mark[6]] || '')].join(','));
      const link = element('a', { download: 'figure-' + this.figure.id + '.csv',
        href: URL.createObjectURL(new Blob([lines.join('\r\n') + '\r\n'], { type: 'text/csv' })) });
      link.click();
      URL.revokeObjectURL(link.href);
    }
  }

  // Rows whose posture or reflector it is, in the tables that have a column of either.
  function rowsOf(visit) {
    for (const table of document.querySelectorAll('main table')) {
      if (!table.tHead) continue;
      const columns = Array.from(table.tHead.rows[table.tHead.rows.length - 1].cells)
        .map((cell, i) => [cell.textContent.trim(), i]).filter(([name]) => /^(posture|pose|reflector|target|part)$/i.test(name));
      if (columns.length === 0) continue;
      for (const body of table.tBodies)
        for (const row of body.rows)
          // A group's header shifts the cells of its other rows: from the right all rows are alike.
          visit(row, columns.map(([name, i]) => [name, row.cells[row.cells.length - (table.tHead.rows[0].cells.length - i)]]).filter(([, cell]) => cell));
    }
  }

  // Whether a row of a table, or a mark of a chart, is of this posture or reflector.
  function isKnown(name) {
    let inTables = false;
    rowsOf((row, cells) => { inTables = inTables || cells.some(([, cell]) => same(cell.textContent.trim(), name)); });
    const inCharts = charts.some((chart) => chart.data.marks.some((mark) => chart.isCalled(mark, name)));
    return { inTables, inCharts };
  }

  // A word that nothing is called empties no table: it is said beside the field.
  function filter(word, says) {
    const { inTables, inCharts } = word === '' ? {} : isKnown(word);
    sought = inTables || inCharts ? word : '';
    filtersTables = Boolean(inTables);
    says.textContent = word !== '' && sought === '' ? 'no posture or reflector is called \u201c' + word + '\u201d' : '';
    update();
  }

  function update() {
    for (const chart of charts) chart.draw();
    rowsOf((row, cells) => {
      const names = cells.map(([, cell]) => cell.textContent.trim());
      const isPosture = cells.some(([name, cell]) => /^pos/i.test(name) && cell.textContent.trim() === marked);
      row.classList.toggle('marked', marked !== '' && isPosture);
      row.classList.toggle('filtered', filtersTables && !names.some((name) => same(name, sought)));
    });
    document.body.classList.toggle('filtering', filtersTables);
  }

  function markPosture(posture, from) {
    marked = posture;
    update();
    // Scenes of all campaigns follow: two days measure the same postures.
    if (posture && from instanceof Chart) {
      const campaigns = (window.stiffscopeScenes || []).map((scene) => scene.data.campaign);
      for (const campaign of campaigns)
        document.dispatchEvent(new CustomEvent('stiffscope-posture', { detail: { campaign, posture, from } }));
    }
  }

  document.addEventListener('stiffscope-posture', (event) => {
    if (!(event.detail.from instanceof Chart)) markPosture(event.detail.posture, event.detail.from);
  });

  for (const script of document.querySelectorAll('script.marks')) {
    const figure = document.querySelector('figure#' + CSS.escape(script.dataset.figure));
    if (figure) charts.push(new Chart(figure, JSON.parse(script.textContent)));
  }

  const nav = document.querySelector('nav');
  if (nav && charts.length > 0) {
    const label = element('label', { class: 'filter' }, 'Posture or reflector ');
    const input = element('input', { type: 'search', placeholder: 'all', size: '8' });
    const says = element('span', { class: 'unknown', role: 'status' });
    input.addEventListener('input', () => filter(input.value.trim(), says));
    label.append(input, says);
    nav.appendChild(label);
  }
  window.addEventListener('resize', () => charts.forEach((chart) => chart.draw()));
  window.stiffscopeCharts = charts;  // for tests and for those who look
})();
