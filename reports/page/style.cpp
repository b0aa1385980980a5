#include "reports/page/style.h"

#include <fmt/format.h>

namespace stiffscope::page {

namespace {

// Pictures are drawn on white paper; in the dark their lightness is turned over, hues stay.
constexpr const char* kScreen =
    ":root{--paper:#fff;--ink:#202024;--faint:#55575e;--line:#dcdfe4;--band:#f4f6f8;--accent:#1c4a96;--shade:#9098a6;"
    "--lay:darken}"
    "@media (prefers-color-scheme:dark){:root{--paper:#17181b;--ink:#e6e7ea;--faint:#a9acb3;--line:#3a3d43;"
    "--band:#212328;--accent:#8fb4f0;--shade:#757d8c;--lay:lighten}}"
    "*{box-sizing:border-box}"
    "body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.5 system-ui,sans-serif}"
    "main,header,nav{min-width:0;padding:0 1.25rem}main header{padding-left:0;padding-right:0}"
    "header{padding-top:1.2rem}main{padding-bottom:3rem}main:focus{outline:none}"
    ".skip{position:absolute;left:-99rem}.skip:focus{left:1rem;top:.5rem;background:var(--paper);padding:.4rem .8rem}"
    "a{color:var(--accent)}:focus-visible{outline:3px solid var(--accent);outline-offset:2px}"
    // The contents stay in view: folded into a bar at the top of a narrow screen, a column at the left of a wide one.
    // Sections and entries are counted alike, each section having one h2 and one entry.
    "nav{position:sticky;top:0;z-index:5;background:var(--paper);border-bottom:1px solid var(--line);display:flex;"
    "flex-wrap:wrap;gap:0 1.5rem;align-items:center;justify-content:space-between}"
    "nav summary{padding:.5rem 0}"
    // Opened it lies over the page, which stays where it is.
    "nav ul{position:absolute;left:0;right:0;top:100%;max-height:calc(100vh - 6rem);overflow-y:auto;columns:16rem;"
    "background:var(--paper);border-bottom:1px solid var(--line);box-shadow:0 .4rem .6rem #0003;list-style:none;"
    "padding:.3rem 1.25rem .7rem;margin:0;max-width:none;font-size:.9rem;counter-reset:entry}"
    "nav li{counter-increment:entry;break-inside:avoid;padding:.2rem 0 .2rem 1.6rem;text-indent:-1.6rem}"
    "nav li::before{content:counter(entry) '\\00a0';color:var(--faint)}nav a{text-decoration:none}nav a:hover{"
    "text-decoration:underline}"
    "main{counter-reset:section}section{scroll-margin-top:3rem}h2{counter-increment:section}"
    "h2::before{content:counter(section) '\\00a0\\00a0';color:var(--faint)}"
    "@media screen and (min-width:75rem){body:has(nav){display:grid;grid-template-columns:13.5rem "
    "minmax(0,1fr);max-width:118rem;"
    "margin:0 auto}header{grid-column:2;grid-row:1}main{grid-column:2;grid-row:2}"
    "nav{grid-column:1;grid-row:1 / span 2;align-self:start;height:100vh;overflow-y:auto;border-bottom:0;display:block;"
    "border-right:1px solid var(--line);padding:1.4rem .8rem 1rem 1.25rem}"
    "nav ul{position:static;max-height:none;columns:auto;border:0;box-shadow:none;padding:0}"
    // There the list stands open; a browser that cannot force it is opened by the page's script.
    "@supports selector(::details-content){nav summary{display:none}"
    "nav details::details-content{content-visibility:visible;display:block}}"
    "section{scroll-margin-top:0}}"
    "h1{font-size:1.9rem;line-height:1.2;margin:0 0 .3rem}"
    "h2{font-size:1.3rem;margin:2.4rem 0 .6rem;padding-top:.7rem;border-top:1px solid var(--line)}"
    "h3{font-size:1.05rem;margin:1.2rem 0 .5rem}"
    "h1,h2,h3,p,li,b{overflow-wrap:anywhere}"
    "p,ul,ol{max-width:60rem;margin:.6rem 0}"
    "header p{max-width:none}header ul{max-width:none}header .cautions{columns:36rem 2;column-gap:2.5rem}.cautions "
    "li{break-inside:avoid}header .faint{margin:.2rem 0;font-size:.95rem}"
    "header .cautions ul,header .several ul{margin:0}.name{font-weight:600;margin:.3rem 0}"
    "sub,sup{line-height:0}"
    ".faint,small{color:var(--faint)}"
    ".stated{font-weight:600;max-width:none;margin:.3rem 0;padding:.2rem .7rem;background:var(--band)}"
    ".verdict{font-size:1.12rem;line-height:1.42;max-width:none;margin:.7rem 0 .4rem}"
    ".next{max-width:none;margin:.3rem 0 .6rem}.judgement{font-weight:600;margin:.3rem 0}.bad{border-left:4px solid "
    "#c8382c;padding-left:.7rem}"
    // The first screen: result and facts beside the picture.
    ".first{display:grid;grid-template-columns:minmax(0,2fr) minmax(0,3fr);gap:0 2rem;align-items:start;margin:.8rem 0}"
    ".first .figures{margin:0;grid-template-columns:minmax(0,1fr);grid-column:2;grid-row:1 / span 2}"
    ".first{grid-template-rows:auto 1fr}.first .told{grid-column:1;grid-row:2}"
    "@media screen and (max-width:60rem){.first{grid-template:none / minmax(0,1fr)}"
    ".first .figures,.first .told{grid-column:1;grid-row:auto}}"
    ".first table{min-width:0;width:100%;font-size:.88rem}.facts td{overflow-wrap:anywhere}"
    ".numbers{display:grid;grid-template-columns:repeat(auto-fit,minmax(14rem,1fr));gap:.8rem;margin:.8rem 0;"
    "padding:0;list-style:none;max-width:none}"
    ".numbers li{background:var(--band);border-left:4px solid var(--accent);padding:.5rem .9rem}"
    ".numbers b{display:block;font-size:1.6rem;line-height:1.25;font-weight:600;"
    "font-variant-numeric:tabular-nums}"
    ".doubted li{border-left-color:var(--faint)}.doubted b{color:var(--faint)}"
    ".numbers span{display:block;color:var(--faint);font-size:.9rem;line-height:1.4}"
    // Campaigns side by side where there is room. In each, tables stand beside each other, what is said of a table at
    // its right, and figures fill what a narrow table leaves.
    ".several{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,44rem),1fr));gap:0 2.5rem}"
    ".each{min-width:0;display:flex;flex-wrap:wrap;gap:0 2.5rem;align-items:flex-start}.each>*{flex:0 0 100%;min-width:"
    "0}.each>.scroll{flex:0 1 auto;max-width:100%}.each>.scroll+.faint{flex:1 1 17rem}.each>.figures{display:contents}"
    ".each figure{flex:1 1 34rem;min-width:0;margin:1rem 0}.each table{min-width:0}.each>p,.each>ul{margin:.35rem 0 "
    ".5rem}"
    "@media screen{.each thead th{max-width:8rem}}"
    ".scroll,.notes,.each p,.each li,.each figure{break-inside:avoid}#versions{columns:16rem 2;column-gap:2.5rem}"
    "#versions h2{column-span:all}"
    ".each table{font-size:.84rem}.grouped tbody th{white-space:nowrap}"
    ".scroll{overflow-x:auto;margin:0 0 1.1rem;padding-top:.1rem}"
    // A shade at an edge beyond which there is more. The paper before it moves with what is scrolled and covers it at
    // the end; a picture, which has no gaps, lets it through.
    ".scroll,.readable{background:linear-gradient(90deg,var(--paper) 60%,transparent) 0 0/2rem 100% no-repeat local,"
    "linear-gradient(270deg,var(--paper) 60%,transparent) 100% 0/2rem 100% no-repeat local,"
    "linear-gradient(90deg,var(--shade),transparent) 0 0/1.1rem 100% no-repeat scroll,"
    "linear-gradient(270deg,var(--shade),transparent) 100% 0/1.1rem 100% no-repeat scroll}"
    ".readable{isolation:isolate}.readable img{mix-blend-mode:var(--lay)}"
    "table{min-width:min(100%,30rem);border-collapse:collapse;font-size:.9rem;font-variant-numeric:tabular-nums}"
    "caption{text-align:left;font-weight:600;padding:0 0 .35rem;position:sticky;left:0;max-width:calc(100vw - 2.6rem)}"
    "th,td{padding:.28rem .42rem;text-align:right;vertical-align:baseline;border-bottom:1px solid var(--line)}"
    "th{font-weight:500}td{white-space:nowrap}.words td{white-space:normal}"
    "thead th{color:var(--faint);vertical-align:bottom;border-bottom:2px solid var(--line)}"
    "tbody th,th:first-child,.grouped thead th:nth-child(2),.words td,.words th{text-align:left}"
    "tbody th:first-child,thead th:first-child{padding-left:0}"
    "tbody+tbody tr:first-child th,tbody+tbody tr:first-child td{border-top:1px solid var(--faint)}"
    ".grouped tbody th{padding-left:.5rem}.grouped tbody th[scope=rowgroup]{padding-left:0}"
    ".words td:last-child{overflow-wrap:anywhere}.words td:nth-child(4):last-child,.words "
    "td:nth-child(5):last-child{width:55%}"
    // On a narrow screen a sentence of a table stands below its row.
    "@media screen{.words td:nth-child(4):last-child,.words td:nth-child(5):last-child{min-width:17rem}"
    ".words:not(.facts) td:nth-child(3):last-child{min-width:7rem}}"
    "@media screen and "
    "(max-width:40rem){.words:has(td:nth-child(4)){&,caption,thead,tbody{display:block}tr{display:grid;"
    "grid-template-columns:1.3fr 1fr 1fr;border-bottom:1px solid var(--line)}th,td{border:0}"
    "td:nth-child(n+4):last-child,th:nth-child(n+4):last-child{grid-column:1/"
    "-1;width:auto;min-width:0;max-width:none;padding-left:0}}"
    ".words:has(td:nth-child(5)) tr{grid-template-columns:1.3fr .8fr 1fr 1fr}}"
    ".numeric tbody th{min-width:4.8rem}.scroll+.faint,.notes{break-before:avoid}"
    "th button{font:inherit;color:inherit;text-align:inherit;background:none;border:0;padding:0;cursor:pointer}"
    "th button:hover{text-decoration:underline}"
    "th[aria-sort=ascending] button::after{content:' \\25B2'}th[aria-sort=descending] button::after{content:' \\25BC'}"
    ".finding{font-weight:600}summary{cursor:pointer;color:var(--accent);font-size:.92rem}details "
    "table{margin-top:.5rem}"
    ".notes{font-size:.85rem;color:var(--faint);padding-left:1.4rem}"
    ".figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,34rem),1fr));gap:1.8rem 2rem;"
    "align-items:start;margin-top:1rem}"
    // A wide figure has its caption beside it.
    "figure{margin:0;padding:0;container-type:inline-size}"
    "figure img{display:block;width:100%;height:auto;background:#fff}.picture{border:1px solid var(--line)}"
    "@media screen{@container (min-width:56rem){figure>.picture,figure>.scene-live{float:left;width:68%}"
    "figcaption{margin:0 0 0 70%}}}"
    // The result of two days is not cut on a phone: an interval in brackets goes to a line of its own.
    "@media screen and (max-width:40rem){.first td{white-space:normal}}"
    // Letters of a chart stay readable on a phone: the figure scrolls in its frame, the page does not.
    "@media screen and (max-width:40rem){.readable{overflow-x:auto;overflow-y:hidden}.readable>img,.readable>.chart{"
    "width:44rem;max-width:none}}"
    "@media screen and (prefers-color-scheme:dark){figure img{filter:invert(.905) hue-rotate(180deg) brightness(1.35)}}"
    "figcaption{font-size:.92rem;margin-top:.5rem;max-width:56rem;overflow-wrap:anywhere}"
    "code{font-family:ui-monospace,monospace;font-size:.85em;overflow-wrap:anywhere}";

// What scripts add: scenes, what is laid over charts, the filter.
constexpr const char* kScripted =
    ".chart{position:relative}canvas.marks{position:absolute;inset:0;width:100%;height:100%;cursor:crosshair}"
    ".tip{position:absolute;pointer-events:none;white-space:pre;background:var(--paper);color:var(--ink);border:1px "
    "solid "
    "var(--faint);padding:.3rem .5rem;font-size:.82rem;margin:.6rem;z-index:3;max-width:20rem;overflow:hidden}"
    ".csv,.offer{font:inherit;font-size:.85rem;color:var(--accent);background:var(--band);border:1px solid var(--line);"
    "cursor:pointer;padding:.05rem .45rem}.filter{font-size:.85rem;color:var(--faint);margin:.4rem "
    "0}.unknown{display:block;color:var(--ink);overflow-wrap:anywhere}.now{display:block;font-weight:600}"
    ".filter input{font:inherit;color:var(--ink);"
    "background:var(--band);border:1px solid var(--faint);padding:.05rem .3rem}"
    "tr.marked th,tr.marked td{background:#e8a82044}tr.filtered{display:none}"
    "figure.live .picture{display:none}.scene-live{border:1px solid var(--line)}"
    ".bar{display:flex;flex-wrap:wrap;gap:.25rem .5rem;align-items:center;padding:.3rem .5rem;font-size:.82rem;"
    "background:var(--band)}.bar button,.bar select{font:inherit;color:var(--ink);background:var(--paper);border:1px "
    "solid "
    "var(--line);padding:.05rem .45rem;max-width:12rem}.bar label{display:inline-flex;align-items:center;gap:.25rem}"
    ".bar i{width:.8em;height:.8em;display:inline-block}"
    ".room{position:relative;overflow:hidden;touch-action:pan-y}.room canvas{display:block}"
    ".room canvas.labels{position:absolute;left:0;top:0;pointer-events:none}"
    ".keys,.numbers-of-point{position:absolute;right:.4rem;top:.4rem;font-size:.8rem;background:var(--paper);opacity:."
    "93;"
    "min-width:0;width:auto;max-width:95%}.first .keys,.first .numbers-of-point "
    "table{font-size:.78rem;width:auto}.keys "
    "th,.keys td{padding:.05rem .5rem;border:0;text-align:left}"
    ".status{font-size:.82rem;color:var(--faint);padding:.25rem .5rem;background:var(--band);min-height:1.7rem;"
    "white-space:pre-wrap}";

constexpr const char* kPrint =
    "@media print{"
    ":root{--paper:#fff;--ink:#000;--faint:#444;--line:#bbb;--band:#f4f6f8;--accent:#1c4a96;--lay:normal}"
    "body{font-size:9.5pt}a{color:inherit;text-decoration:none}nav,.skip,details,.scene-live,.csv,.offer,canvas.marks,."
    "tip,.now{display:none}"
    "figure.live .picture{display:block}.first{grid-template-columns:9fr 11fr;gap:0 6mm}.first "
    ".figures{display:block}.first table{font-size:7.5pt}.first .figures{grid-row:1}.first .told{grid-column:1 / span "
    "2}tr.filtered{display:table-row}"
    "main,header{max-width:none;padding:0}"
    "h1{font-size:18pt}h2{font-size:13pt;margin-top:5mm}h3{font-size:10.5pt;margin:3mm 0 1mm}"
    "h2,h3,caption,thead{break-after:avoid}"
    // A paragraph of a few lines that were broken would leave one of them under a heading.
    "figure,table,caption,tr,p,li,.numbers{break-inside:avoid}table.long{break-inside:auto}"
    // A head that holds buttons is not repeated on the next page.
    "th button{display:contents}"
    // A sentence goes with the table or list that it speaks of, but one that stands below a table goes with that alone:
    // bound to both it would keep two tables together, which are more than a page has left. Facts speak for themselves.
    "p:not(.scroll + .faint):is(:has(+ .scroll:not(.of-facts)),:has(+ ul)){break-after:avoid}"
    ".scroll + .faint{break-inside:auto;orphans:2;widows:2}"
    // The rows of a group stay with its header, which is not repeated, where they are few.
    ".grouped tbody:not(:has(tr:nth-child(9))){break-inside:avoid}"
    // No row of a broken table stands alone. Rows of words are high and do.
    "table:not(.words) tbody tr:nth-child(-n+2):not(:last-child){break-after:avoid}"
    "table:not(.words) tbody tr:nth-last-child(-n+2):not(:first-child){break-before:avoid}"
    ".several,.each,.figures,.each>.figures{display:block}header .cautions{columns:auto}.scroll{break-inside:auto}"
    "#versions,#versions table{break-inside:avoid}"
    "figcaption,.notes,p.faint{font-size:8.5pt}.verdict{font-size:12pt}"
    // A caption is as wide as its table: of a narrow one it would be four lines.
    "table,.each table{font-size:7.5pt;line-height:1.3}.each table{min-width:95mm}th,td{padding:.1rem .36rem}"
    ".figures{margin:0}figure{margin:3mm 0}"
    // The caption beside the figure: three charts fit on a page whatever their captions, and no half of it is empty.
    "figure{container-type:normal}.picture{border:0}main figure{display:grid;grid-template-columns:128mm "
    "minmax(0,1fr);gap:5mm;align-items:start}figcaption{margin:0}"
    "main figure img{max-height:82mm;object-fit:contain;object-position:left top}.first "
    "figcaption{margin-top:1mm;font-size:7.5pt}"
    // Two pictures one above the other stand on the first page; a single one is as wide as its column.
    ".first figure img{max-height:49mm;object-fit:contain;object-position:left top}.first figure{margin:1.5mm 0}"
    ".first .figures:not(:has(figure + figure)) img{max-height:74mm}"
    ".scroll,.readable{overflow:visible;background:none}.scroll{margin-bottom:3mm}caption{max-width:none}"
    "p,ul,ol,figcaption{max-width:none}"
    ".numbers{grid-template-columns:repeat(3,1fr)}.numbers b{font-size:16pt}"
    "}";

}  // namespace

std::string pageStyle(const std::string& report_id) {
  return std::string(kScreen) + kScripted +
         fmt::format(
             "@page{{size:A4;margin:15mm 15mm 17mm;@bottom-left{{content:'Report {}';font:8pt sans-serif}}"
             "@bottom-right{{content:'Page ' counter(page) ' of ' counter(pages);font:8pt sans-serif}}}}",
             report_id) +
         kPrint;
}

}  // namespace stiffscope::page
