// The page of the samples in a real browser. Skipped where chromium or poppler-utils is not installed:
// 300 MB that nothing else needs, so scripts/setup does not bring them (apt-get install chromium poppler-utils).
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/app/browser.h"

namespace stiffscope {
namespace page_browser_test {

/// Measures what is drawn and writes it into the page as JSON. Text is measured by its own boxes; two overlap
/// where they share more than a pixel each way and neither holds the other.
constexpr const char* kMeasure = R"js(<script>
addEventListener('load',function(){
 var boxes=[],out={overlaps:[],clipped:[],requests:[],tabs:0};
 document.querySelectorAll('main details,header details').forEach(function(e){e.open=true;});
 document.querySelectorAll('h1,h2,h3,p,li,caption,th,td,figcaption,img,b,span').forEach(function(e){
  if(e.closest('.skip')||!e.checkVisibility())return;
  if(e.tagName=='LI'&&e.querySelector('b'))return;
  var r;
  if(e.tagName=='IMG')r=e.getBoundingClientRect();
  else{var range=document.createRange();range.selectNodeContents(e);r=range.getBoundingClientRect();}
  if(r.width>0&&r.height>0)boxes.push({e:e,l:r.left,t:r.top,r:r.right,b:r.bottom});
 });
 for(var i=0;i<boxes.length;i++)for(var k=0;k<i;k++){
  var a=boxes[i],b=boxes[k];
  if(a.e.contains(b.e)||b.e.contains(a.e))continue;
  if(Math.min(a.r,b.r)-Math.max(a.l,b.l)>1&&Math.min(a.b,b.b)-Math.max(a.t,b.t)>1){
   var sa=a.e.closest('.scroll'),sb=b.e.closest('.scroll');
   if(sa!=sb){if(sa){var q=sa.getBoundingClientRect();if(b.l>=q.right-1)continue;}
              if(sb){var q=sb.getBoundingClientRect();if(a.l>=q.right-1)continue;}}
   out.overlaps.push(a.e.tagName+':'+a.e.textContent.slice(0,40)+' / '+b.e.tagName+':'+b.e.textContent.slice(0,40));}
 }
 boxes.forEach(function(a){if(!a.e.closest('.scroll,nav,.readable')&&a.r>document.documentElement.clientWidth+1)
  out.clipped.push(a.e.tagName+':'+a.e.textContent.slice(0,40));});
 performance.getEntriesByType('resource').forEach(function(e){if(!e.name.startsWith('data:'))out.requests.push(e.name);});
 document.querySelectorAll('[src],[href],[srcset],[data]').forEach(function(e){
  ['src','href','srcset','data'].forEach(function(n){var v=e.getAttribute(n);
   if(v&&!v.startsWith('data:')&&!v.startsWith('#'))out.requests.push(v);});});
 out.cut=Array.from(document.querySelectorAll('.first .scroll')).filter(e=>e.scrollWidth>e.clientWidth+1).length;
 out.wide=document.documentElement.scrollWidth-document.documentElement.clientWidth;
 // Charts: how wide the narrowest is drawn, and what its frame takes of the page.
 out.charts=0;out.least=1e9;out.frame=0;
 document.querySelectorAll('.readable').forEach(function(e){
  out.charts++;out.frame=Math.max(out.frame,e.getBoundingClientRect().right);
  out.least=Math.min(out.least,e.querySelector('img').getBoundingClientRect().width);});
 out.boxes=boxes.length;
 out.unscoped=document.querySelectorAll('th:not([scope])').length;
 out.alts=document.querySelectorAll('img:not([alt])').length;
 out.landmarks=['header','nav','main','footer'].filter(function(n){return document.querySelector(n);}).length;
 out.sorted=0;out.unsorted=[];  // every sortable column, a click up and a click down
 document.querySelectorAll('table.sorts').forEach(function(t){
  Array.from(t.tHead.rows[0].cells).forEach(function(h,i){
   [1,-1].forEach(function(way){
    h.querySelector('button').click();
    var n=Array.from(t.tBodies[0].rows).map(function(r){return parseFloat(r.cells[i].textContent.replace('\u2212','-'));})
     .filter(function(x){return !isNaN(x);});
    for(var k=1;k<n.length;k++)if(way*(n[k]-n[k-1])<0){out.unsorted.push(t.caption.textContent+': '+h.textContent);return;}
    if(n.length>1)out.sorted++;});});});
 // The contents: what of them is seen, where; opened and chosen from.
 var nav=document.querySelector('nav'),links=Array.from(nav.querySelectorAll('a'));
 function seen(){return links.filter(function(a){return a.checkVisibility()&&a.getBoundingClientRect().height>0;}).length;}
 var bar=nav.getBoundingClientRect();
 out.nav={top:bar.top,height:bar.height,right:bar.right,entries:links.length,seen:seen()};
 nav.querySelector('summary').click();out.nav.opened=seen();links[3].click();out.nav.chosen=seen();
 out.nav.away=document.querySelector('main').getBoundingClientRect().top;  // the page went to what was chosen
 bar=nav.getBoundingClientRect();out.nav.top_then=bar.top;
 var v=document.createElement('pre');v.id='verdict';v.textContent='@@'+JSON.stringify(out)+'@@';
 document.body.appendChild(v);});
</script></body>)js";

class PageInABrowser : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder();
    const std::string samples = STIFFSCOPE_SOURCE_DIR "/samples/";
    status_ =
        runProgram("report '" + samples + "inactive' '" + samples + "active' --paper --out '" + out().string() + "'",
                   scratch_->path())
            .status;
  }
  static void TearDownTestSuite() { delete scratch_; }
  void SetUp() override {
    if (!installed("chromium")) GTEST_SKIP() << "chromium is not installed";
    ASSERT_EQ(status_, 0);
  }

  static std::filesystem::path out() { return scratch_->path() / "out"; }
  static const std::filesystem::path& scratch() { return scratch_->path(); }

  struct Seen {
    nlohmann::json found;  ///< what kMeasure says
    std::string console;   ///< what the page wrote to the console
  };

  /// Of a copy of the page at this width, with `extra` at its end.
  static Seen measured(int width, const std::string& extra = {}) {
    std::string page = contentsOf(out() / "report.html");
    const std::size_t end = page.rfind("</body>");
    page.replace(end, 7, extra + kMeasure);
    const auto copy = scratch() / "copy.html";
    std::ofstream(copy, std::ios::binary) << page;
    const Ran ran = runBrowser(
        "--window-size=" + std::to_string(width) + ",2000 --dump-dom 'file://" + copy.string() + "'", scratch());
    const std::string console = writtenToConsole(ran.err);
    // The script names the marks too; the verdict comes last.
    const std::size_t close = ran.out.rfind("@@"), open = ran.out.rfind("@@{", close);
    if (open == std::string::npos) return {{}, console};
    std::string verdict = ran.out.substr(open + 2, close - open - 2);
    for (std::size_t at = verdict.find("&lt;"); at != std::string::npos; at = verdict.find("&lt;"))
      verdict.replace(at, 4, "<");
    return {nlohmann::json::parse(verdict, nullptr, false), console};
  }

  static inline ScratchFolder* scratch_ = nullptr;
  static inline int status_ = -1;
};

TEST_F(PageInABrowser, NothingOverlapsNothingIsFetched) {
  for (const int width : {500, 1000, 1700}) {  // 500 is the narrowest window of this browser
    SCOPED_TRACE(width);
    const auto [found, console] = measured(width);
    EXPECT_EQ(console, "");
    ASSERT_TRUE(found.is_object());
    EXPECT_GT(found["boxes"], 500);  // it looked at something
    EXPECT_EQ(found["overlaps"].dump(), "[]");
    EXPECT_EQ(found["clipped"].dump(), "[]");
    EXPECT_EQ(found["requests"].dump(), "[]");
    EXPECT_EQ(found["wide"], 0);
    EXPECT_EQ(found["unscoped"], 0);
    EXPECT_EQ(found["alts"], 0);
    EXPECT_EQ(found["landmarks"], 4);
    EXPECT_EQ(found["unsorted"].dump(), "[]");
    EXPECT_GT(found["sorted"], 20);  // of each campaign a handful of tables with numbers
  }
}

// The table of results of two days has intervals in brackets, wider than half of a phone.
TEST_F(PageInABrowser, TheResultIsNotCutOnAPhone) {
  const auto [found, console] = measured(500, "<style>body{max-width:400px}</style>");
  ASSERT_TRUE(found.is_object());
  EXPECT_EQ(found["cut"], 0);
}

// A chart is drawn for about 1400 pixels with letters of 20: half of that is what a reader of a phone needs.
TEST_F(PageInABrowser, LettersOfChartsAreReadOnANarrowScreen) {
  constexpr int kNarrowest = 500;
  const auto [found, console] = measured(kNarrowest);
  ASSERT_TRUE(found.is_object());
  EXPECT_GT(found["charts"], 20);
  EXPECT_GE(found["least"], 700);
  EXPECT_LE(found["frame"], kNarrowest);
  EXPECT_EQ(found["wide"], 0);
}

TEST_F(PageInABrowser, TheContentsAreAtHandOnEveryScreen) {
  const auto narrow = measured(500).found["nav"], wide = measured(1700).found["nav"];
  ASSERT_TRUE(narrow.is_object() && wide.is_object());
  // A bar at the top that stays there, its entries folded in.
  EXPECT_EQ(narrow["top"], 0);
  EXPECT_LT(narrow["height"], 100);
  EXPECT_GT(narrow["entries"], 10);
  EXPECT_EQ(narrow["seen"], 0);
  EXPECT_EQ(narrow["opened"], narrow["entries"]);
  EXPECT_EQ(narrow["chosen"], 0);
  EXPECT_LT(narrow["away"], 0);
  EXPECT_EQ(narrow["top_then"], 0);
  // A column beside the page.
  EXPECT_EQ(wide["seen"], wide["entries"]);
  EXPECT_LT(wide["right"], 600);
}

/// Brightness of a column of a screenshot, rows `from` to `to`: its median, 0 to 255.
int columnOf(const std::string& file, int x, int from, int to) {
  const cv::Mat picture = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (picture.empty() || to > picture.rows || x >= picture.cols) return -1;
  std::vector<int> values;
  for (int y = from; y < to; ++y) values.push_back(picture.at<std::uint8_t>(y, x));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// A table and a chart that are wider than their frames, at their beginning and at their end.
TEST_F(PageInABrowser, AShadeTellsWhatIsCutAndGoesWhereNothingIs) {
  constexpr int kWide = 400, kHigh = 300, kInside = 3;
  for (const bool at_end : {false, true}) {
    std::string page = contentsOf(out() / "report.html");
    const std::string script =
        "<script>addEventListener('load',function(){"
        "var wide=['.scroll','.readable'].map(function(n){return Array.from(document.querySelectorAll('main '+n)).find("
        "function(e){return e.scrollWidth>e.clientWidth+150&&e.clientHeight>150;});});"
        "document.body.replaceChildren.apply(document.body,wide);"
        "wide.forEach(function(e,i){e.style.cssText='position:absolute;left:0;width:400px;height:300px;border:0;"
        "margin:0;top:'+400*i+'px';e.scrollLeft=" +
        std::string(at_end ? "9999" : "0") + ";});});</script></body>";
    page.replace(page.rfind("</body>"), 7, script);
    const auto copy = scratch() / "cut.html";
    const std::string shot = (scratch() / "cut.png").string();
    std::ofstream(copy, std::ios::binary) << page;
    std::filesystem::remove(shot);
    runBrowser(
        "--blink-settings=preferredColorScheme=1 --window-size=500,800 --virtual-time-budget=5000 --screenshot='" +
            shot + "' 'file://" + copy.string() + "'",
        scratch());
    for (const int top : {0, kWide}) {
      SCOPED_TRACE(top == 0 ? "table" : "chart");
      const int left = columnOf(shot, kInside, top + 5, top + kHigh - 5),
                right = columnOf(shot, kWide - 1 - kInside, top + 5, top + kHigh - 5);
      EXPECT_LT(at_end ? left : right, 210) << "the edge beyond which there is more";
      EXPECT_GT(at_end ? right : left, 245) << "the edge beyond which there is nothing";
    }
  }
}

TEST_F(PageInABrowser, TheMeasureSeesFaults) {
  const auto [found, console] =
      measured(1000,
               "<p style='position:absolute;top:30px;left:20px'>over the title</p>"
               "<p style='width:2000px'>wide</p><p style='white-space:nowrap'>" +
                   std::string(400, 'w') + "</p><img src='file:///nowhere.png'><script>console.error('x')</script>");
  ASSERT_TRUE(found.is_object());
  EXPECT_NE(console.find("\"x\""), std::string::npos) << console;
  EXPECT_NE(found["overlaps"].dump().find("over the title"), std::string::npos);
  EXPECT_NE(found["requests"].dump().find("nowhere"), std::string::npos);
  EXPECT_GT(found["wide"], 0);
  EXPECT_EQ(found["alts"], 1);
}

/// No page of a printed report but the last is a third empty: its lowest row with ink, above the foot.
void expectFullPages(const std::string& pdf, int pages) {
  const ScratchFolder drawn;
  runShell("pdftoppm -r 20 -gray '" + pdf + "' '" + (drawn.path() / "page").string() + "'", drawn.path());
  int seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(drawn.path())) {
    if (entry.path().extension() != ".pgm") continue;
    const cv::Mat picture = cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(picture.empty());
    const std::string name = entry.path().stem().string();  // page-07
    const int page = std::stoi(name.substr(name.rfind('-') + 1));
    ++seen;
    const int foot = static_cast<int>(0.93 * picture.rows);
    int lowest = foot;
    while (lowest > 0 && cv::countNonZero(picture.row(lowest) < 200) == 0) --lowest;
    if (page < pages) EXPECT_GT(lowest, foot * 2 / 3) << "page " << page << " of " << pages;
  }
  EXPECT_EQ(seen, pages);
}

/// Measures in the print's style what stays in one piece: boxes that may not break, and such as are bound to their
/// neighbours. What is on the first page is one by its order.
constexpr const char* kPieces = R"js(<script>
addEventListener('load',function(){
 var leaves=[],through=['BODY','HEADER','MAIN','SECTION','DIV','UL','OL','FOOTER','TBODY'];
 function styled(e){return getComputedStyle(e);}
 (function walk(e){
  if(styled(e).display==='none'||e.matches('.first'))return;
  var open=through.includes(e.tagName)&&!e.matches('.numbers')||e.tagName==='TABLE';
  if(open&&!styled(e).breakInside.startsWith('avoid'))return Array.from(e.children).forEach(walk);
  if(e.getBoundingClientRect().height>0)leaves.push(e);
 })(document.body);
 function shownOf(e){return Array.from(e.children).filter(function(c){return styled(c).display!=='none';});}
 function bound(e,top,last){  // e, and what it is the last, or first, of
  for(;e!==top;e=e.parentElement){
   if(styled(e)[last?'breakAfter':'breakBefore'].startsWith('avoid'))return true;
   if(e.parentElement===top)return false;
   var all=shownOf(e.parentElement);if(all[last?all.length-1:0]!==e)return false;}
  return false;}
 function endOf(e){  // of a paragraph that may break, as many lines as stay together at least
  var r=e.getBoundingClientRect(),s=styled(e),line=parseFloat(s.lineHeight);
  var least=Number(s.orphans),few=r.height/line<least+Number(s.widows)-.5;
  return e.tagName!=='P'||s.breakInside.startsWith('avoid')||few?r.bottom:r.top+least*line;}
 var mm=96/25.4,longest={mm:0},from=0;
 for(var i=1;i<=leaves.length;i++){
  if(i<leaves.length){
   var top=leaves[i];while(!top.contains(leaves[i-1]))top=top.parentElement;
   if(bound(leaves[i-1],top,true)||bound(leaves[i],top,false))continue;}
  var high=(endOf(leaves[i-1])-leaves[from].getBoundingClientRect().top)/mm;
  if(high>longest.mm)longest={mm:high,first:leaves[from].textContent.slice(0,60),last:leaves[i-1].textContent.slice(0,60)};
  from=i;}
 var v=document.createElement('pre');v.textContent='@@'+JSON.stringify({pieces:leaves.length,longest:longest})+'@@';
 document.body.appendChild(v);});
</script></body>)js";

/// What kPieces says of a page; `extra` before its end.
nlohmann::json piecesOf(std::string page, const std::filesystem::path& scratch, const std::string& extra = {}) {
  for (const auto& [from, to] :
       {std::pair<std::string, std::string>{"@media print{", "@media all{"}, {"@media screen", "@media speech"}}) {
    for (std::size_t at = page.find(from); at != std::string::npos; at = page.find(from, at + 1))
      page.replace(at, from.size(), to);
  }
  page.replace(page.rfind("</body>"), 7, extra + kPieces);
  const auto copy = scratch / "pieces.html";
  std::ofstream(copy, std::ios::binary) << page;
  constexpr const char* kWidthOfA4 = "680";  // 180 mm between the margins
  const Ran ran = runBrowser(
      std::string("--window-size=") + kWidthOfA4 + ",2000 --dump-dom 'file://" + copy.string() + "'", scratch);
  const std::size_t close = ran.out.rfind("@@"), open = ran.out.rfind("@@{", close);
  if (open == std::string::npos) return {};
  return nlohmann::json::parse(ran.out.substr(open + 2, close - open - 2), nullptr, false);
}

// So that no page is a third empty wherever what is on it begins: nothing that has to stay together is higher than
// that.
TEST_F(PageInABrowser, NothingThatStaysTogetherIsHigherThanAThirdOfAPage) {
  constexpr double kThird = (297.0 - 15.0 - 17.0) / 3.0;  // mm
  for (const std::string day : {"pair", "active", "unloaded"}) {
    SCOPED_TRACE(day);
    const ScratchFolder own;
    if (day != "pair")
      ASSERT_EQ(runProgram("report '" STIFFSCOPE_SOURCE_DIR "/samples/" + day + "' --out '" + own.path().string() + "'",
                           own.path())
                    .status,
                0);
    const std::string page = contentsOf((day == "pair" ? out() : own.path()) / "report.html");
    const nlohmann::json found = piecesOf(page, own.path());
    ASSERT_TRUE(found.is_object());
    EXPECT_GT(found["pieces"], 50);
    EXPECT_LT(found["longest"]["mm"], kThird) << found.dump();
    // It sees what is too high.
    const std::string bound = "<p style='break-after:avoid'>a</p><p style='height:100mm'>b</p>";
    EXPECT_GT(piecesOf(page, own.path(), bound)["longest"]["mm"], 100.0);
  }
}

TEST_F(PageInABrowser, ABrokenTableHasItsHeadOnBothPages) {
  if (!installed("pdftotext")) GTEST_SKIP() << "poppler-utils is not installed";
  const auto heads = [&](const std::string& style) {
    std::string page = contentsOf(out() / "report.html");
    page.replace(page.rfind("</body>"), 7, "<style>" + style + "</style></body>");
    const std::string copy = (scratch() / "heads.html").string(), pdf = (scratch() / "heads.pdf").string();
    std::ofstream(copy, std::ios::binary) << page;
    runBrowser("--no-pdf-header-footer --print-to-pdf='" + pdf + "' 'file://" + copy + "'", scratch());
    const std::string text = runShell("pdftotext '" + pdf + "' -", scratch()).out;
    int count = 0;
    for (std::size_t at = text.find("in direction"); at != std::string::npos; at = text.find("in direction", at + 1))
      ++count;
    return count;
  };
  // The tables of the workspace, one a day, whose heads hold buttons.
  EXPECT_EQ(heads("#workspace table{break-inside:avoid!important}"), 2);
  EXPECT_GE(heads("@media print{#workspace tbody tr:nth-child(8){break-before:page}}"), 4);
}

// Of all tables: a page that has the beginning of a caption has its end, and the table's first row.
TEST_F(PageInABrowser, ACaptionIsOnThePageOfItsTable) {
  if (!installed("pdftotext")) GTEST_SKIP() << "poppler-utils is not installed";
  std::string page = contentsOf(out() / "report.html");
  page.replace(page.rfind("</body>"), 7,
               "<style>caption::before{content:'<<'}caption::after{content:'>>'}"
               "table:has(caption)>tbody:first-of-type>tr:first-child>:first-child::before{content:'@@'}"
               "</style></body>");
  const std::string copy = (scratch() / "captions.html").string(), pdf = (scratch() / "captions.pdf").string();
  std::ofstream(copy, std::ios::binary) << page;
  runBrowser("--no-pdf-header-footer --print-to-pdf='" + pdf + "' 'file://" + copy + "'", scratch());
  std::istringstream pages(runShell("pdftotext -raw '" + pdf + "' -", scratch()).out);
  int tables = 0;
  for (std::string one; std::getline(pages, one, '\f');) {
    const auto count = [&](const std::string& mark) {
      int found = 0;
      for (std::size_t at = one.find(mark); at != std::string::npos; at = one.find(mark, at + 1)) ++found;
      return found;
    };
    EXPECT_EQ(count("<<"), count(">>")) << one;
    EXPECT_EQ(count("<<"), count("@@")) << one;
    tables += count("<<");
  }
  EXPECT_GT(tables, 40);
}

TEST_F(PageInABrowser, OtherDaysPrintOnFullPagesToo) {
  if (!installed("pdfinfo")) GTEST_SKIP() << "poppler-utils is not installed";
  for (const std::string day : {"active", "unloaded"}) {
    SCOPED_TRACE(day);
    const ScratchFolder own;
    const std::string out = (own.path() / "out").string(), pdf = (own.path() / "report.pdf").string();
    ASSERT_EQ(
        runProgram("report '" STIFFSCOPE_SOURCE_DIR "/samples/" + day + "' --out '" + out + "'", own.path()).status, 0);
    runBrowser("--no-pdf-header-footer --print-to-pdf='" + pdf + "' 'file://" + out + "/report.html'", own.path());
    const Ran info = runShell("pdfinfo '" + pdf + "'", own.path());
    ASSERT_EQ(info.status, 0) << info.err;
    expectFullPages(pdf, std::stoi(info.out.substr(info.out.find("Pages:") + 6)));
  }
}

TEST_F(PageInABrowser, PrintsOnFullPagesWithItsIdOnEach) {
  if (!installed("pdfinfo") || !installed("pdftotext")) GTEST_SKIP() << "poppler-utils is not installed";
  const auto pdf = (scratch() / "report.pdf").string(), page = (out() / "report.html").string();
  runBrowser("--no-pdf-header-footer --print-to-pdf='" + pdf + "' 'file://" + page + "'", scratch());
  const Ran info = runShell("pdfinfo '" + pdf + "'", scratch());
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_NE(info.out.find("(A4)"), std::string::npos) << info.out;
  const int pages = std::stoi(info.out.substr(info.out.find("Pages:") + 6));
  // 33 figures up to three a page, and two campaigns of a dozen tables, two pages of the workspace, a page and a half
  // of audit and two of diagnosis each: 31 without what the paper says; other fonts move a page or two.
  EXPECT_GE(pages, 22);
  EXPECT_LE(pages, 42);
  const std::string html = contentsOf(page);
  const std::string id = html.substr(html.find("content:'Report ") + 16, 14);
  for (int i = 1; i <= pages; ++i) {
    const std::string n = std::to_string(i);
    const Ran text = runShell("pdftotext -f " + n + " -l " + n + " '" + pdf + "' -", scratch());
    EXPECT_NE(text.out.find(id), std::string::npos) << "page " << n;
    EXPECT_NE(text.out.find("Page " + n + " of " + std::to_string(pages)), std::string::npos) << "page " << n;
  }
  expectFullPages(pdf, pages);
}

}  // namespace page_browser_test
}  // namespace stiffscope
