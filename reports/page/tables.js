'use strict';

// Sorts the rows of a table of class `sorts` by the column whose header is clicked: numbers by the first number in them,
// words by the alphabet, what has neither last; a second click turns the order. Headers become buttons here, so that
// without script none promises what it cannot do. Groups of rows (tbody) stay together. The contents are folded here, too.
(function () {
  function keyOf(row, column) {
    const text = row.cells[column].textContent.replace(/\u2212/g, '-').trim();
    if (text === '' || text === '\u2013') return null;
    const number = parseFloat(text);
    return isNaN(number) ? text.toLowerCase() : number;
  }

  function inOrder(a, b, down) {
    if (a === b) return 0;
    if (a === null) return 1;  // whichever the direction
    if (b === null) return -1;
    let order;
    if (typeof a !== typeof b) order = typeof a === 'number' ? -1 : 1;
    else order = typeof a === 'number' ? a - b : a.localeCompare(b);
    return down ? -order : order;
  }

  function sort(table, heads, column) {
    const down = heads[column].getAttribute('aria-sort') === 'ascending';
    for (const head of heads) head.removeAttribute('aria-sort');
    heads[column].setAttribute('aria-sort', down ? 'descending' : 'ascending');
    for (const body of table.tBodies) {
      const rows = Array.from(body.rows).map((row) => [keyOf(row, column), row]);
      rows.sort((a, b) => inOrder(a[0], b[0], down));
      for (const [, row] of rows) body.appendChild(row);
    }
  }

  for (const table of document.querySelectorAll('table.sorts')) {
    const heads = Array.from(table.tHead.rows[0].cells);
    heads.forEach((head, column) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.title = 'Sort by this column';
      while (head.firstChild) button.appendChild(head.firstChild);
      head.appendChild(button);
      button.addEventListener('click', () => sort(table, heads, column));
    });
  }

  // The contents: open beside the page where there is room, closed again by a choice where they lie over it.
  const fold = document.querySelector('nav details');
  if (fold) {
    const wide = window.matchMedia('(min-width:75rem)');
    const follow = () => { fold.open = wide.matches; };
    wide.addEventListener('change', follow);
    follow();
    fold.addEventListener('click', (event) => { if (event.target.closest('a') && !wide.matches) fold.open = false; });
    document.addEventListener('keydown', (event) => { if (event.key === 'Escape' && !wide.matches) fold.open = false; });
  }
})();
