/* Turns the paths under a dragging pointer or the arrow keys. Reads what stands in #paths, draws into #turn. */
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
