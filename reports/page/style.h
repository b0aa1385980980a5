#pragma once

#include <string>

namespace stiffscope::page {

/// Sorts the rows of a table of class `sorts` by the column whose header is clicked: numbers by the first number in
/// them, words by the alphabet, what has neither last; a second click turns the order. Headers become buttons here, so
/// that without script none promises what it cannot do. Groups of rows (tbody) stay together. Like the style sheet it
/// has no '<', '>' or '&', which would be escaped, and no mark of a rich text.
inline constexpr const char* kSortScript =
    "document.querySelectorAll('table.sorts').forEach(function(table){"
    "var heads=Array.from(table.tHead.rows[0].cells);"
    "function key(row,i){var t=row.cells[i].textContent.replace(/\\u2212/g,'-').trim();"
    "var n=parseFloat(t);return t==='\\u2013'||t===''?null:isNaN(n)?t.toLowerCase():n;}"
    "function order(a,b){if(a===b)return 0;if(a===null)return 1;if(b===null)return -1;"
    "if(typeof a!==typeof b)return typeof a==='number'?-1:1;"
    "return typeof a==='number'?a-b:a.localeCompare(b);}"
    "heads.forEach(function(head,i){"
    "var button=document.createElement('button');button.type='button';button.title='Sort by this column';"
    "while(head.firstChild)button.appendChild(head.firstChild);head.appendChild(button);"
    "button.addEventListener('click',function(){"
    "var down=head.getAttribute('aria-sort')==='ascending';"
    "heads.forEach(function(h){h.removeAttribute('aria-sort');});"
    "head.setAttribute('aria-sort',down?'descending':'ascending');"
    "Array.from(table.tBodies).forEach(function(body){"
    "Array.from(body.rows).map(function(row){return [key(row,i),row];})"
    ".sort(function(a,b){var o=order(a[0],b[0]);return a[0]===null||b[0]===null||!down?o:-o;})"
    ".forEach(function(pair){body.appendChild(pair[1]);});});});});});";

/// The style sheet of the page: light and dark, on a screen and on A4, there with the report's id (hex digits and
/// hyphens) and the page's number at the foot. It has no '<', '>' or '&', which would
/// be escaped, because HTML does not unescape inside <style>.
std::string pageStyle(const std::string& report_id);

}  // namespace stiffscope::page
