// The page of the samples in a real browser. Skipped where chromium or poppler-utils is not installed:
// 300 MB that nothing else needs, so scripts/setup does not bring them (apt-get install chromium poppler-utils).
#include <gtest/gtest.h>

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
 document.querySelectorAll('details').forEach(function(e){e.open=true;});
 document.querySelectorAll('h1,h2,h3,p,li,caption,th,td,figcaption,img,b,span').forEach(function(e){
  if(e.closest('.skip'))return;
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
