// The report's style sheet and its one script. Both stand in the page, so that a report is a folder that needs nothing.
#pragma once

namespace trocar::reports {

inline constexpr const char* kReportStyle = R"(
:root{--paper:#fff;--ink:#1d2126;--soft:#59616b;--line:#d5dae0;--panel:#f5f7f9;--good:#176b3a;--bad:#b3261e;
--s0:#0060a8;--s1:#b35900;--s2:#00745a;--s3:#8a2f73;--s4:#5d6570;--s5:#3f4650;--b0:#cfe0ee;--b1:#e3ecd9}
@media (prefers-color-scheme:dark){:root{--paper:#14171a;--ink:#e6e9ec;--soft:#a3acb5;--line:#333a41;--panel:#1c2125;
--good:#63c98d;--bad:#ff8a80;--s0:#6cb4f0;--s1:#f0a35c;--s2:#4cc9a4;--s3:#d78cc2;--s4:#9aa4ae;--s5:#c0c7ce;
--b0:#2b4358;--b1:#3a4a2c}}
*{box-sizing:border-box}
body{font:16px/1.55 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:62rem;margin:0 auto;
padding:1.5rem 1.2rem 4rem}
h1{font-size:1.7rem;line-height:1.2;margin:0 0 .2rem}h2{font-size:1.2rem;margin:2.6rem 0 .6rem}
h3{font-size:1rem;margin:1.4rem 0 .3rem}
p{margin:.4rem 0}.note,.legend,figcaption,caption,footer{color:var(--soft);font-size:.88rem}
.verdict{display:flex;flex-wrap:wrap;gap:.3rem 2rem;align-items:baseline;margin:1rem 0;padding:.9rem 1.1rem;
background:var(--panel);border-left:5px solid var(--soft);border-radius:3px}
.verdict.passed{border-color:var(--good)}.verdict.failed{border-color:var(--bad)}
.verdict b{font-size:1.35rem}.passed b.word{color:var(--good)}.failed b.word{color:var(--bad)}
table{border-collapse:collapse;width:100%;margin:.4rem 0;font-variant-numeric:tabular-nums}
caption{text-align:left;padding-bottom:.25rem}
th,td{text-align:left;padding:.28rem .7rem .28rem 0;border-bottom:1px solid var(--line);vertical-align:top}
thead th{font-weight:600;font-size:.88rem;color:var(--soft)}td.n,th.n{text-align:right}td.n{white-space:nowrap}
tr.sum td,tr.sum th{font-weight:700;border-top:2px solid var(--ink)}
.wide{overflow-x:auto}.bad-text{color:var(--bad)}.good-text{color:var(--good)}
.pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(13.5rem,1fr));gap:.9rem}
figure{margin:0}figure img{width:100%;height:auto;border-radius:3px;display:block;background:#000}
.views{display:grid;grid-template-columns:repeat(auto-fit,minmax(13rem,1fr));gap:.8rem}
.curves{grid-template-columns:repeat(auto-fill,minmax(17rem,1fr))}
svg{width:100%;height:auto;display:block}.legend svg{display:inline-block;width:28px;height:8px;vertical-align:middle}
.legend span{margin-right:1rem;white-space:nowrap}
.line{fill:none;stroke-width:1.5;stroke-linejoin:round}
.s0{stroke:var(--s0)}.s1{stroke:var(--s1);stroke-dasharray:7 2}.s2{stroke:var(--s2);stroke-dasharray:2 2}
.s3{stroke:var(--s3);stroke-dasharray:8 2 2 2}.s4{stroke:var(--s4)}.s5{stroke:var(--s5)}
.dot{stroke-dasharray:none;stroke-width:2;fill:var(--paper)}
.grid{stroke:var(--line);stroke-width:1}.axis{stroke:var(--soft);stroke-width:1}
.level{stroke:var(--bad);stroke-width:1;stroke-dasharray:4 4}.frame{fill:none;stroke:var(--line)}
text{fill:var(--ink);font:12px system-ui,sans-serif}.tick{fill:var(--soft);font-size:11px}.label{fill:var(--soft)}
.in-bar{font-size:11px}.bar.b0{fill:var(--b0)}.bar.b1{fill:var(--b1)}.bad{fill:var(--bad)}
.clock{stroke:var(--soft);stroke-width:1;stroke-dasharray:1 3}.event{stroke:var(--soft);stroke-width:2}
#turn{touch-action:none;cursor:grab;border:1px solid var(--line);border-radius:3px;max-width:34rem;margin:0 auto}
#turn-box{display:none}.scripted #turn-box{display:block}
button{font:inherit;font-size:.88rem;color:var(--ink);background:var(--panel);border:1px solid var(--line);
border-radius:3px;padding:.15rem .7rem;margin:.2rem .3rem .2rem 0}
details summary{cursor:pointer;color:var(--soft)}footer{margin-top:3rem;border-top:1px solid var(--line);padding-top:.6rem}
@media print{:root{--paper:#fff;--ink:#000;--soft:#444;--line:#bbb;--panel:#fff;--good:#176b3a;--bad:#b3261e;
--s0:#0060a8;--s1:#b35900;--s2:#00745a;--s3:#8a2f73;--b0:#dde8f0;--b1:#eaf0e2}
body{max-width:none;padding:0;font-size:11pt}#turn-box,.scripted #turn-box{display:none}
figure,table,svg{break-inside:avoid}h2{break-after:avoid}}
)";

/// Turns the paths under a dragging pointer or the arrow keys. Reads what stands in #paths, draws into #turn.
inline constexpr const char* kReportScript = R"(
(function(){
var data=JSON.parse(document.getElementById('paths').textContent),svg=document.getElementById('turn');
document.documentElement.classList.add('scripted');
var yaw=-0.5,tilt=0.35,part=1,S=300,r=data.radius||1,c=data.centre,lines=[];
data.paths.forEach(function(p){var e=document.createElementNS('http://www.w3.org/2000/svg','path');
e.setAttribute('class','line s'+p.style);svg.appendChild(e);lines.push(e)});
var axes=['x','y','z'].map(function(n,i){var e=document.createElementNS('http://www.w3.org/2000/svg','text');
e.setAttribute('class','tick');e.textContent=data.axes[i];svg.appendChild(e);return e});
function at(p){var x=p[0]-c[0],y=p[1]-c[1],z=p[2]-c[2],a=Math.cos(yaw),b=Math.sin(yaw),d=Math.cos(tilt),s=Math.sin(tilt);
var u=a*x+b*y,w=-b*x+a*y;return [S+u/r*S*0.92,S-(z*d+w*s)/r*S*0.92]}
function draw(){data.paths.forEach(function(p,i){var n=Math.max(2,Math.round(p.points.length*part)),t='';
for(var k=0;k<n&&k<p.points.length;k++){var q=at(p.points[k]);t+=(k?'L':'M')+q[0].toFixed(1)+' '+q[1].toFixed(1)}
lines[i].setAttribute('d',t)});
axes.forEach(function(e,i){var p=c.slice();p[i]+=r*0.97;var q=at(p);e.setAttribute('x',q[0]);e.setAttribute('y',q[1])})}
var drag=null;
svg.addEventListener('pointerdown',function(e){drag=[e.clientX,e.clientY];svg.setPointerCapture(e.pointerId)});
svg.addEventListener('pointermove',function(e){if(!drag)return;yaw+=(e.clientX-drag[0])*0.01;tilt+=(e.clientY-drag[1])*0.01;
drag=[e.clientX,e.clientY];draw()});
svg.addEventListener('pointerup',function(){drag=null});
svg.addEventListener('keydown',function(e){var k={ArrowLeft:[-.1,0],ArrowRight:[.1,0],ArrowUp:[0,.1],ArrowDown:[0,-.1]}[e.key];
if(k){yaw+=k[0];tilt+=k[1];draw();e.preventDefault()}});
document.getElementById('part').addEventListener('input',function(e){part=e.target.value/100;draw()});
draw();
})();
)";

}  // namespace trocar::reports
