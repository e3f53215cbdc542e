var df=Object.defineProperty;var _t=(i,e,t)=>()=>{if(t)throw t[0];try{return i&&(e=i(i=0)),e}catch(n){throw t=[n],n}};var Yc=(i,e)=>{for(var t in e)df(i,t,{get:e[t],enumerable:!0})};var eh={};Yc(eh,{BsmError:()=>Tn,CorruptError:()=>ze,DEFAULT_LIMITS:()=>ff,Decoder:()=>pf,END_OF_STREAM:()=>mf,FormatError:()=>Nr,Helper:()=>Kc,Kernels:()=>gf,LimitError:()=>Ai,NEED_BLOCK:()=>Jc,NEED_DATA:()=>yf,NumericError:()=>jc,TruncatedError:()=>Ur,UnsupportedError:()=>Ti,bsm:()=>Dr,checkLimit:()=>Qc,decode:()=>_f,errorLike:()=>ri,hasVectors:()=>xf,openDesk:()=>el,serve:()=>vf});var $c,Dr,Tn,ze,ff,pf,mf,Nr,Kc,gf,Ai,Jc,yf,jc,Ur,Ti,Qc,_f,ri,xf,el,vf,Nt=_t(()=>{$c=function(){var e=class extends Error{constructor(y,M={}){super(y),this.problem=y,this.name="BsmError",this.place={},this.located(M)}get described(){return{name:this.name,problem:this.problem,place:this.place}}located(y){this.place.offset??=y.offset,this.place.frame??=y.frame,this.place.block??=y.block;let{offset:M,frame:T,block:F}=this.place,D=this.problem||"this stream is wrong; bsm.js says how",L=[["byte",M],["frame",T],["block",F]].flatMap(([q,Q])=>Q===void 0?[]:[`${q} ${Q}`]);return this.message=L.length?`${D} [${L.join(", ")}]`:D,this}},t=class extends e{constructor(){super(...arguments),this.name="FormatError"}},n=class extends e{constructor(){super(...arguments),this.name="UnsupportedError"}},s=class extends e{constructor(){super(...arguments),this.name="CorruptError"}},r=class extends e{constructor(){super(...arguments),this.name="TruncatedError"}},a=class extends e{constructor(){super(...arguments),this.name="LimitError"}},o=class extends e{constructor(){super(...arguments),this.name="NumericError"}},l=[t,n,s,r,a,o];function c({name:y,problem:M,place:T}){let F=l.find(D=>new D("").name===y)??e;return new F(M,T)}var h={vertices:16777216,faces:33554432,blocks:131072,blockSize:8192,coefficients:4096,frames:1048576,gopFrames:1024,frameBytes:268435456,metadataBytes:8388608,attributes:255,attributeValues:268435456,sequenceBytes:2147483648,work:8e8,workPerVertex:32e3,workPerByte:16e3,memoryPerByte:64,blockMemory:67108864,blockMemoryPerVertex:1024},d={...h,keptBytes:2**30,memory:2**31};function u(y,M,T){if(T>y[M])throw new a(`${M} = ${T} is over the limit of ${y[M]}; raise it if you trust the source`)}var f=class Zc{constructor(M){this.module=M}static async compile(M){return new Zc(await WebAssembly.compile(M))}borrow(){let M=this.waiting??new WebAssembly.Instance(this.module).exports;return this.waiting=void 0,M}take(M){M.memory.buffer.byteLength<=16777216&&(this.waiting=M)}};function g(){return globalThis.navigator?.hardwareConcurrency??1}function b(){let y=[0,97,115,109,1,0,0,0,1,5,1,96,0,1,123,3,2,1,0,10,8,1,6,0,65,0,253,15,11];return WebAssembly.validate(Uint8Array.from(y))}var p=["generic","color","normal","texcoord"],m=["vertex","corner","face"],S=["uint8","int8","uint16","int16","uint32","int32","float32","float64"],C={3:"Format",4:"Corrupt",5:"Unsupported",6:"Limit",7:"Numeric",8:"Limit",12:"Truncated"};function E(y){return`${C[y]??"Bsm"}Error`}var P=class{constructor(y,M,T,...F){this.kernels=y,this.exports=y.borrow();let D={...d,...M},L=[D.vertices,D.faces,D.blocks,D.blockSize,D.coefficients,D.frames,D.gopFrames,D.frameBytes,D.metadataBytes,D.attributes,D.attributeValues,D.sequenceBytes,D.memory,D.work,D.workPerVertex,D.workPerByte,1/0,D.blockMemory,D.blockMemoryPerVertex,D.memoryPerByte,1/0,D.memory];if(this.decoder=this.r(8*L.length,q=>(new Float64Array(this.buffer,q).set(L),this.e(T,q,...F))),!this.decoder)throw new a("this machine has no memory for a decoder")}get buffer(){return this.own.memory.buffer}e(y,...M){let{own:T}=this;try{return T[y](...M)>>>0}catch(F){throw this.exports=void 0,F}}doubles(y,M){return new Float64Array(this.buffer,M>0?y:0,M).slice()}r(y,M){let T=this.e("page_take",y);if(T===0)throw new a(`this machine has no ${y} bytes of memory for the decoder`);try{return M(T)}finally{this.exports&&this.e("page_give",T,y)}}end(y){let{exports:M}=this;M&&(this.e(y),this.kernels.take(M),this.exports=void 0)}get own(){if(!this.exports)throw new Error("this decoder was released");return this.exports}},[R,_,w,H,O,z,$,te,U,j,ie,Z,,he]=Array.from({length:14},(y,M)=>M),K=[Uint8Array,Int8Array,Uint16Array,Int16Array,Uint32Array,Int32Array,Float32Array,Float64Array],[oe,le,Re]=[1,2,3],Ne=new TextDecoder("utf-8",{ignoreBOM:!0}),se=255,[ye,Se]=[48,56],[Le,_e]=[31,39],Be=class extends P{constructor(y,M,T,{number:F,among:D}={number:0,among:0}){super(y,M,"page_open",T?1:0,F,D)}push(y){y.length!==0&&this.r(y.length,M=>{new Uint8Array(this.buffer,M).set(y),this.e("bsmdec_push",this.decoder,M,y.length)})}finish(){this.e("bsmdec_finish",this.decoder)}share(y){this.e("page_share",y)}next(){let y=this.e("page_next"),M=new DataView(this.buffer,y),[T,F,D,L]=[8,16,24,32].map(q=>Number(M.getBigInt64(q,!0)));return{type:M.getInt32(0,!0),index:T,count:F,vertices:D,faces:L}}error(y=!1){let M=this.e("page_error",y?1:0),T=new DataView(this.buffer,M),[F,D,L]=[8,16,24].map(q=>Number(T.getBigInt64(q,!0))).map(q=>q<0?void 0:q);return c({name:E(T.getInt32(0,!0)),problem:this.text(M+32),place:{offset:F,frame:D,block:L}})}get state(){let[y,M,T]=this.doubles(this.e("page_state"),3);return[y,M,T]}header(){let y=this.doubles(this.e("page_header"),_e),M=(T,F,D)=>T>0?[...y.subarray(F,D)]:[];return{vertices:y[0],faces:y[1],blocks:y[2],blockSize:y[3],coefficients:y[4],keyInterval:y[5],step:y[6],scale:y[7],smoothing:y[8],attributes:y[9],light:y[10],frames:y[11],gopFrames:y[12],run:y[13],again:y[14]<0?void 0:y[14],center:M(1,15,18),refinement:M(y[18],19,21),grid:M(y[21],22,25),lattice:M(y[25],25,27),corner:M(y[27],28,31),bits:y[Le]}}metadata(y,M){let T=new Map;return this.r(ye,F=>{for(let D=y;D<M;D++){this.e("page_metadata",D,F);let L=new DataView(this.buffer,F),q=L.getInt32(4,!0),Q=this.f(L.getUint32(24,!0),L.getUint32(28,!0)),X=L.getBigInt64(8,!0),be=X>=-(2n**31n)&&X<2n**32n?Number(X):X,xe=q===oe?be:q===le?L.getFloat64(16,!0):q===Re?Ne.decode(Q):Q;T.set(this.text(L.getUint32(0,!0)),xe)}}),T}faces(y){return this.i(Int32Array,3*y.faces,"bsmdec_faces")}loose(){let{vertices:y,positions:M}=this.d("page_loose");return{vertices:y,positions:M}}positions(y){return this.i(Float64Array,3*y,"bsmdec_positions")}changes(){return this.d("page_changes")}d(y){let[M,T,F,D]=this.rows(y);return{vertices:this.p(T,M),positions:this.doubles(F,3*M),final:this.f(D,M)}}losses(){let[y,M,T,F]=this.rows("page_losses");return{missing:this.p(M,y),degraded:this.p(T,this.doubles(F,1)[0])}}attribute(y,M=!1){return this.r(Se,T=>{if(this.e("bsmdec_attribute_at",this.decoder,y,T)!==0)return;let F=new DataView(this.buffer,T),[D,L,q,Q]=[4,8,12,16].map(Je=>F.getInt32(Je,!0)),[X,be]=[24,32].map(Je=>Number(F.getBigInt64(Je,!0)));if(M&&F.getInt32(40,!0)===0)return;let xe=this.text(F.getUint32(0,!0)),He=this.i(Uint8Array,X*Q*K[q].BYTES_PER_ELEMENT,"bsmdec_attribute_values",y),st=be>0?this.i(Int32Array,be,"bsmdec_attribute_indices",y):void 0,dt=new K[q](He.buffer,0,X*Q);return{name:xe,semantic:p[L],domain:m[D],kind:S[q],components:Q,values:Float64Array.from(dt),indices:st}})}attributes(y=!1){return Array.from({length:se+1},(M,T)=>this.attribute(T,y)).filter(M=>M!==void 0)}handed(y){let[M,T,F,D]=this.rows("page_handed");return{index:y,block:{vertices:new Int32Array(this.buffer,T,M).slice(),positions:this.doubles(F,3*M),weights:this.doubles(D,M)}}}add({index:y,block:M}){if(!M)return void this.e("page_lose",y);let[,T,F,D]=this.rows("page_room",M.vertices.length);if(new Int32Array(this.buffer,T).set(M.vertices),new Float64Array(this.buffer,F).set(M.positions),new Float64Array(this.buffer,D).set(M.weights),!this.e("page_add",y))throw new RangeError("a block that is none of this mesh")}release(){this.end("page_close")}rows(y,...M){let T=this.e(y,...M);if(T===0)throw this.error();return new Uint32Array(this.buffer,T,4).slice()}p(y,M){return new Int32Array(this.buffer,M>0?y:0,M).slice()}f(y,M){return new Uint8Array(this.buffer,y,M).slice()}text(y){let M=new Uint8Array(this.buffer,y);return Ne.decode(M.slice(0,M.indexOf(0)))}i(y,M,T,...F){return this.r(Math.max(1,M)*y.BYTES_PER_ELEMENT,D=>{if(this.e(T,this.decoder,...F,D,M)!==0)throw this.error();return new y(this.buffer,D,M).slice()})}},ot="need data",Pe="end of stream",Ke="need block",Qe=class{constructor(y,M={},T={}){this.wishes=T,this.y=[],this.metadata=0,this.b=!1,this.n={attributes:[],faces:new Int32Array(0)},this.shared=new Map,this.engine=new Be(y,M,T.tolerant??!1)}receiveData(y){this.engine.push(y)}receiveEof(){this.engine.finish()}receiveBlock(y){this.shared.set(y.index,y)}get position(){return this.engine.state[0]}get work(){return this.engine.state[1]}get vertices(){return this.engine.state[2]}nextEvent(){return this.next(!this.wishes.whole)}release(){this.engine.release()}finish(){let{n:y}=this;this.receiveEof();for(let M;(M=this.next(!1))!==Pe;){if(M===Ke)throw new TypeError("a decoder with helpers gives events; it cannot finish alone");if(!(typeof M=="string"||y.first)){if(M.type==="connectivity"&&(y.faces=M.faces),M.type==="attribute"&&y.attributes.push(qe(M)),M.type==="frame"){let{positions:T,attributes:F}=M,D=y.attributes.map(L=>F.find(({name:q})=>q===L.name)??L);y.first={positions:T,faces:y.faces,attributes:D}}M.type==="end"&&(y.first={positions:M.positions??new Float64Array(0),faces:y.faces,attributes:y.attributes})}}return y.first}next(y){if(this.error)throw this.error;try{for(;;){let M=this.y.shift()??(this.s===void 0?this.x(this.engine.next(),y):this.received(this.s,y));if(M)return M}}catch(M){throw M instanceof e&&(this.error=M),M}}x(y,M){let{engine:T,wishes:F}=this,{type:D,index:L,count:q,vertices:Q}=y;if(D===R)return ot;if(D===ie)return Pe;if(D===Z)throw T.error();if(D===he&&(this.s=L),D===_)return this.I(T.header());if(D===w){let xe=T.metadata(this.metadata,L);return this.metadata=L,{type:"metadata",entries:xe}}if(D===H){let[xe,He]=[T.faces(y),T.loose()];return this.b&&this.y.push(...T.attributes().map(st=>({type:"attribute",...st}))),{type:"connectivity",faces:xe,vertices:Q,loose:He}}if(M&&(D===O||D===z))return this.g(D===O?L:void 0);if(D===$)return{type:"attribute",...T.attribute(L)};if(D===te)return{type:"frame",index:L,positions:T.positions(Q),attributes:T.attributes(!0)};if(D===U){let xe=this.header.gopFrames>0&&L>=0;return{type:"loss",block:xe||L<0?void 0:L,...xe?{frames:{first:L,count:q}}:{},error:T.error(!0).described}}if(D!==j)return;let X=this.header.gopFrames===0,be={type:"end",...F.tolerant&&X?T.losses():{missing:new Int32Array(0),degraded:new Int32Array(0)}};return!M&&X?{...be,positions:T.positions(Q)}:be}I(y){let{wishes:M,engine:T}=this;this.header=y,this.b=y.again!==void 0;let F=y.run>0?0:M.helpers?.(y)??0;return T.share(F>0?F+1:0),{type:"header",header:y}}g(y){let M=this.engine.changes();return y===void 0?{type:"refinement",...M}:{type:"block",index:y,...M}}received(y,M){let T=this.shared.get(y);if(!T)return Ke;this.shared.delete(y),this.s=void 0;let{problem:F}=T;if(F&&(!this.wishes.tolerant||this.header.gopFrames>0))throw c(F);return this.engine.add(T),F?{type:"loss",block:y,error:F}:M?this.g(y):void 0}};function qe({type:y,...M}){return M}function At(y,M,T={}){let F=new Qe(y,T);try{return F.receiveData(M),F.finish()}finally{F.release()}}var yt=class{constructor(y,M,T={},F=!1){this.v=!1,this.over=!1,this.engine=new Be(y,T,F,M)}receiveData(y){this.over||this.engine.push(y)}receiveEof(){this.over||this.engine.finish()}release(){this.engine.release()}nextBlock(){let{engine:y}=this;for(;!this.over;){let{type:M,index:T}=y.next();if(M===R)return ot;if(M===O)return y.handed(T);if(M===U&&T>=0)return{index:T,problem:y.error(!0).described};if(M===_&&(this.over=this.v,this.v=!0),(M===ie||M===Z)&&(this.over=!0),M===Z){let F=y.error().described;if(F.place.block!==void 0)return{index:F.place.block,problem:F}}}return Pe}};function bt(y,M,T){if(!T)return new Float32Array(y);let F=new Float32Array(M*T.length);for(let D=0;D<T.length;D++)for(let L=0;L<M;L++)F[M*D+L]=y[M*T[D]+L];return F}function ut(y){let M=new Int32Array(y);for(let T=0;T<y;T++)M[T]=T;return M}function un(y,M){let T=new Int32Array(M+1);for(let L of y)L>=0&&T[L+1]++;for(let L=0;L<M;L++)T[L+1]+=T[L];let F=new Int32Array(T[M]),D=T.slice();return y.forEach((L,q)=>L>=0&&(F[D[L]++]=q)),{starts:T,members:F}}var[Mt,Yt]=["material","part"],$t={texcoord:"uv",color:"color",normal:"normal"};function Zt(y,M,T,F){let D=[Yt,Mt].map(we=>T.find(et=>et.name===we&&et.domain==="face"&&et.components===1)),[L,q]=D.map(we=>et=>we?.values[et]??0);D.some(Boolean)&&M.sort((we,et)=>L(we)-L(et)||q(we)-q(et)||we-et);let Q=[],X;M.forEach((we,et)=>{X?.part===L(we)&&X.material===q(we)?X.count+=3:Q.push(X={part:L(we),material:q(we),start:3*et,count:3})});let be=T.filter(we=>!D.includes(we)),{index:xe,vertices:He,rows:st}=Kt(y,M,be,F),dt=be.find(({semantic:we,domain:et})=>we==="normal"&&et!=="face"),Je=new Map([["position",1],["normal",1]]),ft=be.flatMap((we,et)=>{if(we===dt)return[];let gn=we.semantic==="generic"?we.name:$t[we.semantic],Gn=Je.get(gn)??0;return Je.set(gn,Gn+1),[{name:Gn?`${gn}${Gn}`:gn,source:we.name,components:we.components,values:rt(we,st[et])}]});return{index:xe,vertices:He,pieces:Q,attributes:ft,own:dt&&rt(dt,st[be.indexOf(dt)])}}function B({domain:y,values:M,components:T,indices:F},D,L){let q=new Int32Array(3*L.length),Q=new Map;return L.forEach((X,be)=>{let xe=X;if(y==="face"){let He=M.subarray(T*X,T*(X+1)).join();xe=Q.get(He)??X,Q.set(He,xe)}for(let He=0;He<3;He++){let st=3*X+He;q[3*be+He]=y==="face"?xe:y==="corner"?F?.[st]??0:D[st]}}),q}function Kt(y,M,T,F){let D=new Uint32Array(3*M.length),L=T.filter(({domain:Je})=>Je!=="vertex");if(L.length===0)return M.forEach((Je,ft)=>{for(let we=0;we<3;we++)D[3*ft+we]=y[3*Je+we]}),{index:D,rows:T.map(()=>{})};let q=L.map(Je=>B(Je,y,M)),[Q,X]=[new Int32Array(F).fill(-1),new Int32Array(D.length)],[be,xe]=[new Int32Array(D.length),new Int32Array(D.length)],He=0;for(let Je=0;Je<D.length;Je++){let ft=y[3*M[Math.floor(Je/3)]+Je%3],we=Q[ft];for(;we>=0&&!q.every(et=>et[xe[we]]===et[Je]);)we=X[we];we<0&&(we=He++,[X[we],Q[ft],be[we],xe[we]]=[Q[ft],we,ft,Je]),D[Je]=we}let st=be.slice(0,He),dt=T.map(Je=>{let ft=q[L.indexOf(Je)];return ft?xe.subarray(0,He).map(we=>ft[we]):st});return{index:D,vertices:st,rows:dt}}function rt({semantic:y,kind:M,components:T,values:F},D){let L=y==="color"?{uint8:255,uint16:65535}[M]??1:1,q=bt(F,T,D);if(L>1)for(let Q=0;Q<q.length;Q++)q[Q]/=L;return q}var lt=30,ge=32767,xt=class{constructor(y,M,T){this.growing=y,this.t=T,this.faces=new Int32Array(0),this.points=new Float32Array(0),this.normals=new Float32Array(0),this.origin=new Int32Array(0),this.refined=new Uint8Array(0),this.waiting=new Uint8Array(0),this.u={starts:new Int32Array(1),members:new Int32Array(0)},this.o=[],this.a=new Uint8Array(0),this.c=[],this.blocks=0,this.shown=0,this.carried=[],this.n=0,this.run=0,this.limits={...d,...M}}accept(y){switch(y.type){case"header":return y.header.run>0?this.S(y.header.run):this.t(y);case"connectivity":return this.begin(y);case"block":case"refinement":return this.D(y);case"attribute":return this.carried.push(y),this.run>0?void 0:this.t({type:"attribute",name:y.name,semantic:y.semantic,domain:y.domain});case"frame":return this.T(y);case"loss":return this.flush(),this.t(y);case"end":return this.flush(),y.positions&&this.take(y.positions),this.shape||this.finish(),this.t({...y,positions:void 0});default:return this.t(y)}}S(y){this.flush(),[this.run,this.growing]=[y,!1],this.faces=new Int32Array(0),[this.points,this.normals,this.origin]=[new Float32Array(0),new Float32Array(0),new Int32Array(0)],[this.carried.length,this.shape]=[0,void 0]}flush(){if(!this.growing||this.o.length+this.c.length===0)return;let y=Int32Array.from(this.o);this.o=[];let[M,T]=[new Float32Array(3*y.length),new Float32Array(3*y.length)],[F,D]=[new Int32Array(y.length),new Uint8Array(y.length)];y.forEach((q,Q)=>{this.a[q]=0,this.M(q);for(let X=0;X<3;X++)M[3*Q+X]=this.points[3*q+X],T[3*Q+X]=this.normals[3*q+X];F[Q]=this.origin[q],D[Q]=this.refined[q]});let L=this.A(this.c);this.c=[],this.shown=performance.now(),this.t({type:"grown",vertices:y,positions:M,normals:T,origin:F,refined:D,index:L,blocks:this.blocks},[y,M,T,F,D,L].map(({buffer:q})=>q))}begin({faces:y,vertices:M,loose:T}){this.faces=y,this.origin=new Int32Array(M).fill(-1),this.points=new Float32Array(3*M),this.normals=new Float32Array(3*M),T.vertices.forEach((F,D)=>this.points.set(T.positions.subarray(3*D,3*D+3),3*F)),this.growing&&(this.t({type:"begun",vertices:M,corners:y.length,loose:T}),this.refined=new Uint8Array(M),this.a=new Uint8Array(M),this.waiting=new Uint8Array(y.length/3).fill(3),this.u=un(y,M))}w(y){this.a[y]||(this.a[y]=1,this.o.push(y))}D(y){let{vertices:M,positions:T}=y,{points:F,origin:D,growing:L}=this;for(let q=0;q<M.length;q++){let Q=M[q];for(let X=0;X<3;X++)F[3*Q+X]=T[3*q+X];L?this.B(Q):D[Q]=this.blocks}if(y.type==="block")this.blocks++;else if(L)for(let q of M)this.refined[q]=1;L&&performance.now()-this.shown>lt&&this.flush()}B(y){let{faces:M,waiting:T,origin:F}=this,{starts:D,members:L}=this.u,q=F[y]<0;q&&(F[y]=this.blocks),this.w(y);for(let Q=D[y];Q<D[y+1];Q++){let X=Math.floor(L[Q]/3);q&&--T[X]===0&&this.c.push(X);for(let be=3*X;be<3*X+3;be++)this.w(M[be])}}M(y){let{faces:M,waiting:T,normals:F,points:D}=this,{starts:L,members:q}=this.u,[Q,X,be]=[0,0,0];for(let He=L[y];He<L[y+1];He++){let st=Math.floor(q[He]/3);if(T[st]>0)continue;let dt=3*M[3*st],Je=3*M[3*st+1],ft=3*M[3*st+2],[we,et,gn]=[D[Je]-D[dt],D[Je+1]-D[dt+1],D[Je+2]-D[dt+2]],[Gn,Ds,Si]=[D[ft]-D[dt],D[ft+1]-D[dt+1],D[ft+2]-D[dt+2]];Q+=et*Si-gn*Ds,X+=gn*Gn-we*Si,be+=we*Ds-et*Gn}let xe=Math.sqrt(Q*Q+X*X+be*be)||1;F[3*y]=Q/xe,F[3*y+1]=X/xe,F[3*y+2]=be/xe}A(y){let M=new Uint32Array(3*y.length);for(let T=0;T<M.length;T++)M[T]=this.faces[3*y[Math.floor(T/3)]+T%3];return M}take(y){this.points=new Float32Array(y),this.origin.fill(0)}T({index:y,positions:M,attributes:T}){this.n+=18*(M.length/3)+T.reduce((xe,{values:He})=>xe+4*He.length,0),u(this.limits,"keptBytes",this.n),this.shape||(this.take(M),this.finish());let{vertices:F,attributes:D}=this.shape,L=bt(M,3,F),q=bt(Ie(this.faces,this.origin,M),3,F),Q=new Int16Array(q.length);for(let xe=0;xe<Q.length;xe++)Q[xe]=Math.round(q[xe]*ge);let X=T.flatMap(xe=>{let He=D.find(({source:st})=>st===xe.name);return He?[{...He,values:rt(xe,F)}]:[]}),be=[L,Q,...X.map(({values:xe})=>xe)].map(({buffer:xe})=>xe);this.t({type:"frame",index:y,positions:L,normals:Q,attributes:X},be)}finish(){this.flush(),this.growing=!1;let{faces:y,origin:M,points:T,carried:F}=this,D=we=>M[y[we]]>=0,L=ut(y.length/3),q=M.includes(-1)?L.filter(we=>D(3*we)&&D(3*we+1)&&D(3*we+2)):L,{index:Q,vertices:X,pieces:be,attributes:xe,own:He}=F.length>0?Zt(y,q,F,T.length/3):this.L(q),st=bt(T,3,X),dt=He??bt(Ie(y,M,T),3,X),Je=this.shape={index:Q,positions:st,normals:dt,attributes:xe,vertices:X,pieces:be,...Ue(st)},ft=[Q,st,dt,...xe.map(({values:we})=>we)].map(({buffer:we})=>we);this.run>0&&(this.n+=ft.reduce((we,{byteLength:et})=>we+et,0)),this.t({type:"whole",shape:Je,run:this.run},ft)}L(y){let M=3*y.length===this.faces.length?new Uint32Array(this.faces):this.A(y);return{index:M,pieces:M.length>0?[{part:0,material:0,start:0,count:M.length}]:[],attributes:[]}}};function Ie(y,M,T){let F=new Float32Array(T.length);for(let D=0;D<y.length;D+=3){if(M[y[D]]<0||M[y[D+1]]<0||M[y[D+2]]<0)continue;let L=3*y[D],q=3*y[D+1],Q=3*y[D+2],X=T[q]-T[L],be=T[q+1]-T[L+1],xe=T[q+2]-T[L+2],He=T[Q]-T[L],st=T[Q+1]-T[L+1],dt=T[Q+2]-T[L+2],Je=be*dt-xe*st,ft=xe*He-X*dt,we=X*st-be*He;F[L]+=Je,F[L+1]+=ft,F[L+2]+=we,F[q]+=Je,F[q+1]+=ft,F[q+2]+=we,F[Q]+=Je,F[Q+1]+=ft,F[Q+2]+=we}for(let D=0;D<F.length;D+=3){let L=Math.sqrt(F[D]*F[D]+F[D+1]*F[D+1]+F[D+2]*F[D+2])||1;F[D]/=L,F[D+1]/=L,F[D+2]/=L}return F}function Ue(y){let[M,T]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let Q=0;Q<y.length;Q+=3)for(let X=0;X<3;X++)y[Q+X]<M[X]&&(M[X]=y[Q+X]),y[Q+X]>T[X]&&(T[X]=y[Q+X]);let[F,D,L]=M.map((Q,X)=>(Q+T[X])/2),q=0;for(let Q=0;Q<y.length;Q+=3)q=Math.max(q,(y[Q]-F)**2+(y[Q+1]-D)**2+(y[Q+2]-L)**2);return{center:[F,D,L],radius:Math.sqrt(q),low:M,high:T}}function A(y,M,T,F=new f(M.kernels)){let D=!1,L,q=()=>{D||L?.close(),D=!0},Q=be=>{if(!D)try{be()}catch(xe){q(),T(xe instanceof e?{problem:xe.described}:{fault:`${xe}`})}},X=(be,xe)=>{D||(("over"in be||"through"in be)&&q(),T(be,xe))};return Q(()=>L=y(M,F,X,Q)),{take:be=>Q(()=>L?.take(be)),stop:q}}function x(y,M,T={}){let F=new Map;y.onmessage=({data:D})=>{if("help"in D)return x(D.help,M,T);let{task:L}=D;"start"in D?(T.kernels??=new f(D.start.kernels),F.set(L,A(M,D.start,(q,Q=[])=>y.postMessage({task:L,...q},Q),T.kernels))):"stop"in D?(F.get(L)?.stop(),F.delete(L)):F.get(L)?.take(D.data)}}function G(y){return{openDesk:(M,T)=>A(y,M,T),serve(){let M=self;x(M,y),M.postMessage({ready:!0},[])}}}var ce=class{constructor(y,M,T){this.decoder=y,this.start=M,this.E=T,this.taken=0;let{drawing:F,limits:D,reported:L=0}=M;this.reported=-L,F&&(this.drawing=new xt(F==="growing",D,(q,Q)=>this.say({picture:q},Q)))}take(y){y?this.decoder.receiveData(y):this.decoder.receiveEof(),this.taken+=y?.length??0}close(){this.decoder.release()}report(){try{return this.F()}catch(y){throw this.drawing?.flush(),this.E({reported:this.reported}),y}}F(){for(;;){let y=this.decoder.nextEvent();if(typeof y=="string")return this.drawing?.flush(),y===ot&&this.say({taken:this.taken}),y===Pe&&this.say({over:!0}),y;if(this.drawing)this.drawing.accept(y);else if(y.type==="frame"){let M=Float32Array.from(y.positions);this.say({event:{...y,positions:M}},[M.buffer])}else this.say({event:y});this.reported<0&&this.drawing?.flush(),(y.type!=="block"||this.start.drawing!=="whole")&&this.reported++}}say(y,M){this.reported>=0&&this.E(y,M)}};function ae({keyInterval:y,blocks:M},T){return Math.floor(T/(y||M))}var ue=3,de=0;function ee(y,M=8192){return y.vertices<M?0:Math.max(0,Math.min(ae(y,y.blocks-1)+1,g(),ue+1)-1)}var ne=class{constructor(y,M,T){this.members=y,this.listener=T,this.k=y.length,y.forEach((F,D)=>{let L={number:D+1,among:1+y.length};F.onmessage=({data:q})=>this.hear(q),F.postMessage({task:de,start:{...M,share:L}})})}take(y){for(let M of this.members)M.postMessage({task:de,data:y})}close(){for(let y of this.members)y.postMessage({task:de,stop:!0}),y.close()}hear(y){"fault"in y?(this.close(),this.listener.onOver(y.fault)):"shared"in y?this.listener.onBlock(y.shared):("through"in y||"problem"in y)&&--this.k===0&&this.listener.onOver("all helpers are through")}},fe=class{constructor(y,M,T,F){this.start=y,this.guarded=F,this.pieces=[];let{limits:D,tolerant:L,drawing:q}=y,Q=q==="whole"&&!L;this.decoder=new Qe(M,D,{tolerant:L,whole:Q,helpers:X=>this._(X)}),this.h=new ce(this.decoder,y,T)}take(y){this.pieces?.push(y),this.l?.take(y),this.h.take(y),this.report()}close(){this.l?.close(),this.h.close()}_(y){let{kernels:M,limits:T,tolerant:F,helpers:D=[],worthwhile:L}=this.start,q=this.pieces??[],Q=D.slice(0,ee(y,L));if(this.pieces=void 0,Q.length===0)return 0;let X=xe=>this.guarded(()=>{this.decoder.receiveBlock(xe),this.report()}),be=xe=>this.guarded(()=>{this.over=xe,this.report()});this.l=new ne(Q,{kernels:M,limits:T,tolerant:F},{onBlock:X,onOver:be});for(let xe of q)this.l.take(xe);return Q.length}report(){if(this.h.report()===Ke&&this.over!==void 0)throw new Error(`a block does not come: ${this.over}`)}},I=class{constructor({limits:y,tolerant:M},T,F,D){this.say=D,this.m=new yt(T,F,y,M)}take(y){let{m:M}=this;y?M.receiveData(y):M.receiveEof();for(let T;(T=M.nextBlock())!==ot;){if(T===Pe)return this.say({through:!0});let{block:F}=T;this.say({shared:T},F&&[F.vertices.buffer,F.positions.buffer,F.weights.buffer])}}close(){this.m.release()}},{openDesk:re,serve:J}=G((y,M,T,F)=>y.share?new I(y,M,y.share,T):new fe(y,M,T,F));return{BsmError:e,CorruptError:s,DEFAULT_LIMITS:d,Decoder:Qe,END_OF_STREAM:Pe,FormatError:t,Helper:yt,Kernels:f,LimitError:a,NEED_BLOCK:Ke,NEED_DATA:ot,NumericError:o,TruncatedError:r,UnsupportedError:n,checkLimit:u,decode:At,errorLike:c,hasVectors:b,openDesk:re,serve:J}},Dr=$c,{BsmError:Tn,CorruptError:ze,DEFAULT_LIMITS:ff,Decoder:pf,END_OF_STREAM:mf,FormatError:Nr,Helper:Kc,Kernels:gf,LimitError:Ai,NEED_BLOCK:Jc,NEED_DATA:yf,NumericError:jc,TruncatedError:Ur,UnsupportedError:Ti,checkLimit:Qc,decode:_f,errorLike:ri,hasVectors:xf,openDesk:el,serve:vf}=$c()});var Hn,th,tl,nh,ih,nl,sh,Yi=_t(()=>{Hn=[137,66,83,77,16],th=128,tl=5,nh={1:"header",2:"metadata",3:"connectivity",12:"grid",15:"end"},ih={vertices:1,attributes:12,light:16,sequence:17,paper:19},nl={vertices:{key:1,type:"int",low:1,high:2147483647},faces:{key:2,type:"int",low:1,high:2147483647},center:{key:8,type:"float",low:-1e300,high:1e300,default:[0,0,0],lengths:[3,3]},scale:{key:9,type:"float",low:1e-300,high:1e300,default:1},grid:{key:13,type:"int",low:0,high:1048575,default:[],lengths:[0,3]},lattice:{key:14,type:"int",low:1,high:2147483647,default:[],lengths:[0,2]},corner:{key:15,type:"int",low:-2147483648,high:2147483647,default:[],lengths:[0,3]},light:{key:16,type:"int",low:0,high:2,default:0}},sh={vertices:16777216,faces:33554432,blocks:131072,blockSize:8192,coefficients:4096,frames:1048576,gopFrames:1024,frameBytes:268435456,metadataBytes:8388608,attributes:255,attributeValues:268435456,sequenceBytes:2147483648,work:8e8,workPerVertex:32e3,workPerByte:16e3,memoryPerByte:64,blockMemory:67108864,blockMemoryPerVertex:1024}});function $i(i){let e=new il(i),t=[];for(let n=e.mapSize();n>0;n--){let s=e.key(),r=t.at(-1)?.[0];if(r&&bf(r,s)>=0)throw new ze("the keys of a map must ascend");t.push([s,e.value(!0)])}return e.finish(),t}function bf(i,e){if(i.type==="int"&&e.type==="int")return i.value<e.value?-1:i.value>e.value?1:0;if(i.type==="int"||e.type==="int")throw new ze("the keys of a map must be all of one type");let t=i.bytes,n=e.bytes;for(let s=0;s<Math.min(t.length,n.length);s++)if(t[s]!==n[s])return t[s]-n[s];return t.length-n.length}var Fr,Mf,il,Or=_t(()=>{Nt();Fr=256;Mf=[["int",204,128],["string",217,32],["binary",196,0]],il=class{constructor(e){this.data=e;this.at=0;this.left=Fr;this.view=new DataView(e.buffer,e.byteOffset,e.byteLength)}mapSize(){let e=this.byte();if(e>=128&&e<=143)return e&15;if(e!==222)throw new ze("expected a msgpack map in its shortest form");return this.atMost(this.shortest(this.unsigned(2),16))}key(){let e=this.value(!1);if(e.type==="string"||e.type==="int"&&e.value>=0)return e;throw new ze("the keys of a map must be unsigned integers or strings")}finish(){if(this.at!==this.data.length)throw new ze("bytes behind a map")}value(e){let t=this.byte();if(t<128||t>=224)return{type:"int",value:t<<24>>24};if(t>=160&&t<=191)return this.text(t&31);if(e&&t>=144&&t<=159)return this.array(t&15);if(e&&t===220)return this.array(this.shortest(this.unsigned(2),16));for(let[n,s,r]of Mf){if(t<s||t>s+2)continue;let a=t-s,o=this.shortest(this.unsigned(1<<a),[r,256,65536][a]);return n==="int"?{type:n,value:o}:n==="string"?this.text(o):{type:n,value:this.bytes(o)}}switch(t){case 207:return this.integer(this.view.getBigUint64(this.take(8)),n=>n>=1n<<32n);case 208:return this.integer(this.view.getInt8(this.take(1)),n=>n<-32);case 209:return this.integer(this.view.getInt16(this.take(2)),n=>n<-128);case 210:return this.integer(this.view.getInt32(this.take(4)),n=>n<-32768);case 211:return this.integer(this.view.getBigInt64(this.take(8)),n=>n<-(1n<<31n));case 202:return{type:"float",value:this.finite(this.view.getFloat32(this.take(4)))};case 203:return this.double()}throw new ze(`a map may not hold a value that begins with byte ${t} here`)}array(e){if(this.left-=e,this.left<0)throw new ze(`the arrays of a map have more than ${Fr} entries`);return{type:"array",value:Array.from({length:this.atMost(e)},()=>this.value(!1))}}text(e){let t=this.bytes(e);try{return{type:"string",value:new TextDecoder("utf-8",{fatal:!0,ignoreBOM:!0}).decode(t),bytes:t}}catch{throw new ze("a string of a map is not UTF-8")}}double(){let e=this.finite(this.view.getFloat64(this.take(8)));if(Math.fround(e)===e)throw new ze("a number of a map is not in its shortest form");return{type:"float",value:e}}integer(e,t){if(!t(e))throw new ze("an integer of a map is not in its shortest form");return{type:"int",value:e}}shortest(e,t){if(e<t)throw new ze("a map is not in its shortest form");return e}atMost(e){if(e>Fr)throw new ze(`more than ${Fr} entries in a map or an array`);return e}finite(e){if(!Number.isFinite(e))throw new ze("a map may not hold a number that is not finite");return e}byte(){return this.data[this.take(1)]}bytes(e){let t=this.take(e);return this.data.slice(t,t+e)}unsigned(e){return this.bytes(e).reduce((t,n)=>256*t+n,0)}take(e){if(e>this.data.length-this.at)throw new ze("a map ends too early");return this.at+=e,this.at-e}}});function Zi(i,e,t){let n=0;for(let s=0;s<tl&&e+s<t;s++){let r=i[e+s];if(n+=(r&127)*2**(7*s),r<128){if(r===0&&s>0)throw new ze("a varint is not in its shortest form");return{value:n,end:e+s+1}}}if(!(t-e<tl))throw new ze("a varint is longer than five bytes")}var Br=_t(()=>{Yi();Nt()});function ah(){return globalThis.navigator?.hardwareConcurrency??1}function Wn(){let i=[0,97,115,109,1,0,0,0,1,5,1,96,0,1,123,3,2,1,0,10,8,1,6,0,65,0,253,15,11];return WebAssembly.validate(Uint8Array.from(i))}var Us=_t(()=>{});function Rn(i,e,t){if(t>i[e])throw new Ai(`${e} = ${t} is over the limit of ${i[e]}; raise it if you trust the source`)}var ai,oi=_t(()=>{Yi();Nt();ai={...sh,keptBytes:2**30,memory:2**31}});var Ri,sl=_t(()=>{Ri=class i{constructor(e){this.module=e}static async compile(e){return new i(await WebAssembly.compile(e))}borrow(){let e=this.waiting??new WebAssembly.Instance(this.module).exports;return this.waiting=void 0,e}take(e){e.memory.buffer.byteLength<=16777216&&(this.waiting=e)}}});function Ki(i,e=0){let t=~e;for(let n=0;n<i.length;n++)t=Sf[(t^i[n])&255]^t>>>8;return~t>>>0}function oh(i){let e=0;for(let t=0;t<i.length;t++)e=e<<8&65535^wf[e>>8^i[t]];return e}var Sf,wf,rl=_t(()=>{Sf=Uint32Array.from({length:256},(i,e)=>{let t=e;for(let n=0;n<8;n++)t=t&1?t>>>1^3988292384:t>>>1;return t}),wf=Uint16Array.from({length:256},(i,e)=>{let t=e<<8;for(let n=0;n<8;n++)t=t&32768?t<<1^4129:t<<1;return t})});function lh(i){return`${Ef[i]??"Bsm"}Error`}var Ef,kr,ch=_t(()=>{Nt();oi();Ef={3:"Format",4:"Corrupt",5:"Unsupported",6:"Limit",7:"Numeric",8:"Limit",12:"Truncated"};kr=class{constructor(e,t,n,...s){this.kernels=e;this.exports=e.borrow();let r={...ai,...t},a=[r.vertices,r.faces,r.blocks,r.blockSize,r.coefficients,r.frames,r.gopFrames,r.frameBytes,r.metadataBytes,r.attributes,r.attributeValues,r.sequenceBytes,r.memory,r.work,r.workPerVertex,r.workPerByte,1/0,r.blockMemory,r.blockMemoryPerVertex,r.memoryPerByte,1/0,r.memory];if(this.decoder=this.lent(8*a.length,o=>(new Float64Array(this.buffer,o).set(a),this.call(n,o,...s))),!this.decoder)throw new Ai("this machine has no memory for a decoder")}get buffer(){return this.own.memory.buffer}call(e,...t){let{own:n}=this;try{return n[e](...t)>>>0}catch(s){throw this.exports=void 0,s}}doubles(e,t){return new Float64Array(this.buffer,t>0?e:0,t).slice()}lent(e,t){let n=this.call("page_take",e);if(n===0)throw new Ai(`this machine has no ${e} bytes of memory for the decoder`);try{return t(n)}finally{this.exports&&this.call("page_give",n,e)}}end(e){let{exports:t}=this;t&&(this.call(e),this.kernels.take(t),this.exports=void 0)}get own(){if(!this.exports)throw new Error("this decoder was released");return this.exports}}});var Af,zr,hh=_t(()=>{Nt();Af={start:["header"],header:["connectivity"],connectivity:["grid","end"],grid:["grid","end"]},zr=class{constructor(){this.last="start";this.entryNames=new Set;this.nextVertex=0}get ended(){return this.last==="end"}check(e){let{header:t,nextVertex:n}=this;if(!(e.type==="metadata"?t:Af[this.last]?.includes(e.type)))throw new ze(`unexpected section ${e.type}`);if(e.type==="metadata"){for(let r of e.entries.keys())if(this.entryNames.has(r))throw new ze(`duplicate metadata name "${r}"`)}if(t){if(e.type==="grid"){let{first:r,count:a}=e;if(r!==n)throw new ze(`vertices begin at ${r}, expected ${n}`);if(a===0||a>t.vertices-r)throw new ze(`${a} vertices from ${r} on`)}if(e.type==="end"&&n<t.vertices)throw new ze(`the positions end at vertex ${n} of ${t.vertices}`)}}advance(e){if(e.type==="metadata"){for(let t of e.entries.keys())this.entryNames.add(t);return}e.type==="header"&&(this.header=e.header),e.type==="grid"&&(this.nextVertex=e.first+e.count),this.last=e.type}}});function fh(i,e){if(i.length>dh)throw new ze(`a header of ${i.length} bytes, where ${dh} are legal`);let t=new Map($i(i).map(([o,l])=>[o.value,l])),{light:n,grid:s}=nl;if([...t.keys()].some(o=>!uh.some(([,l])=>l.key===o))||t.get(n.key)?.value!==Tf||!t.has(s.key))throw new Ti("this build decodes light grids alone, which this is not; small.js and bsm.js decode more");let a={...Rf,...Object.fromEntries(uh.map(([o,l])=>[o,Cf(o,l,t.get(l.key))]))};return Pf(a),Rn(e,"vertices",a.vertices),Rn(e,"faces",a.faces),a}function Cf(i,e,t){let{type:n,low:s,high:r,lengths:a=[1,1]}=e;if(!t){if(e.default===void 0)throw new ze(`the header lacks ${i}`);return e.default}let l=(e.lengths&&t.type==="array"?t.value:[t]).map(c=>c.type===n?Number(c.value):NaN);if(l.length<a[0]||l.length>a[1]||!l.every(c=>c>=s&&c<=r)||e.lengths&&t.type!=="array")throw new ze(`header field ${i} has another type, or is outside its legal range`);if(`${l}`==`${e.default}`)throw new ze(`header field ${i} is stored with its default value`);return e.lengths?l:l[0]}function Pf({vertices:i,faces:e,center:t,corner:n,grid:s,lattice:r}){let[a,o]=r.length===2?r:[0,0];Ci("more vertices than the corners of its faces",i>3*e),Ci("a grid of other than three axes",s.length!==3),Ci("a lattice that is not cells and points",r.length===1),Ci("a lattice with fewer points than the grid has values",o>0&&o<Math.max(...s)),Ci("a lattice of more points than cells",o>a),Ci("a corner of other than three axes",n.length%3!==0),Ci("a corner and a center",n.length>0&&t.some(l=>l!==0))}function Ci(i,e){if(e)throw new ze(`the header contradicts itself: ${i}`)}var uh,dh,Tf,Rf,ph=_t(()=>{Yi();Nt();oi();Or();uh=Object.entries(nl),dh=2**16,Tf=1,Rf={blocks:0,blockSize:0,coefficients:0,keyInterval:0,step:2**-8,smoothing:0,attributes:0,refinement:[],frames:0,gopFrames:0,run:0,again:void 0,bits:0}});function Vr(i){return i.reduceRight((e,t)=>e*256+t,0)}var Gr,mh,gh=_t(()=>{Nt();ph();oi();Or();Br();Gr=class{constructor(e){this.payload=e;this.at=0}varint(){let e=Zi(this.payload,this.at,this.payload.length);if(!e)throw new ze("a payload ends inside a varint");return this.at=e.end,e.value}take(e){if(e>this.payload.length-this.at)throw new ze(`a payload lacks ${e} bytes`);return this.at+=e,this.payload.subarray(this.at-e,this.at)}rest(){return this.take(this.payload.length-this.at)}get ended(){return this.at===this.payload.length}finish(){if(this.at!==this.payload.length)throw new ze("a payload has bytes too many")}},mh={header:(i,e)=>({type:"header",header:fh(i.rest(),e)}),metadata:(i,e)=>{let t=i.rest();Rn(e,"metadataBytes",t.length);let n=new Map;for(let[s,r]of $i(t)){if(s.type!=="string"||r.type==="array")throw new ze("metadata of a wrong type");n.set(s.value,r.value)}return{type:"metadata",entries:n}},connectivity:i=>({type:"connectivity",data:i.rest()}),grid:i=>({type:"grid",first:i.varint(),count:i.varint(),data:i.rest()}),end:i=>{let e=i.varint(),t=i.take(4),n=i.ended?void 0:Vr(i.take(4));return i.finish(),{type:"end",frames:e,crc:Vr(t),positions:n}}}});var Pi,Ji,Hr=_t(()=>{Pi="need data",Ji="end of stream"});function Bf(i){let e=i.value%16,t=Math.floor(i.value/16),n=i.end+t;return{type:e,length:t,sum:n,end:n+(e===Ff||t<th?2:4)}}var If,Lf,Df,Nf,yh,Uf,Ff,Of,Wr,_h=_t(()=>{Yi();rl();Nt();hh();oi();gh();Hr();Br();[If,Lf,Df,Nf]=[8e3,8,2e4,8e3],yh=4,Uf=15,Ff=6,Of=nh;Wr=class{constructor(e,t){this.limits=e;this.charge=t;this.begin=0;this.end=0;this.eof=!1;this.grammar=new zr;this.buffer=new Uint8Array(0);this.offset=0;this.frames=0;this.crc=0;this.metadataRead=0;this.started=!1}receiveData(e){if(this.eof)throw new Error("bytes were given to a reader after receiveEof");this.error||e.length===0||(this.end+e.length>this.buffer.length&&this.makeRoom(e.length),this.buffer.set(e,this.end),this.end+=e.length)}receiveEof(){this.eof=!0}get position(){return this.offset}nextPacket(){if(this.error)throw this.error;try{return this.next()}catch(e){throw e instanceof Tn&&(this.error=e.located({offset:this.offset,frame:this.started?this.frames:void 0}),this.buffer=new Uint8Array(0)),e}}makeRoom(e){let t=this.end-this.begin,n=t+e>this.buffer.length/2?new Uint8Array(2*(t+e)+1024):this.buffer;n.set(this.buffer.subarray(this.begin,this.end)),this.buffer=n,this.begin=0,this.end=t}next(){if(!this.started&&!this.start())return Pi;for(;!this.grammar.ended;){let e=this.frame();if(!e)return this.incomplete();this.charge(If+Lf*e.size,e.size);let t=this.parse(e.type,e.payload);if(t?.type==="metadata"&&this.charge(Df+Nf*t.entries.size,0),t&&this.grammar.advance(t),t?.type==="metadata"&&(this.metadataRead+=e.payload.length),this.crc=Ki(this.buffer.subarray(this.begin,this.begin+e.size),this.crc),this.skip(e.size),t)return t}if(this.end>this.begin)throw new ze("data after END");return this.eof?Ji:Pi}start(){let e=this.buffer.subarray(this.begin,Math.min(this.end,this.begin+Hn.length));for(let t=0;t<e.length;t++)if(!((e[t]^Hn[t])<=(t<yh?0:Uf)))throw t<yh?new Nr("not a BSM stream: it does not begin with 89 42 53 4D",{offset:0}):new Ti(`written by version ${e[t]>>4}, and this reads ${Hn[t]>>4}; if that is later, encode the source again`,{offset:t});return e.length<Hn.length?(this.incomplete(),!1):(this.crc=Ki(e),this.drop(Hn.length),this.started=!0,!0)}incomplete(){if(!this.eof)return Pi;throw new Ur("the stream ends before its END frame; get the rest of it",{offset:this.offset+this.end-this.begin})}frame(){let e=this.begin,t=Zi(this.buffer,e,this.end);if(!t)return;let{type:n,length:s,sum:r,end:a}=Bf(t);if(Rn(this.limits,"frameBytes",s),a>this.end)return;let o=this.buffer.subarray(e,r),l=a-r===2?oh(o):Ki(o);if(Vr(this.buffer.subarray(r,a))!==l)throw new ze(`the checksum of a frame of type ${n} and ${s} bytes is wrong`);return{type:n,payload:this.buffer.slice(t.end,r),size:a-e}}parse(e,t){if(e>=8&&e<=11){if(!this.grammar.header)throw new ze("the first frame must be HEADER");return}let n=Of[e],s=mh[n];if(!s)throw new Ti(`frame type ${e} is unknown to this decoder`);let r=s(new Gr(t),this.limits);if(this.grammar.check(r),n==="metadata"&&Rn(this.limits,"metadataBytes",this.metadataRead+t.length),r.type==="end"){if(r.frames!==this.frames)throw new ze(`END counts ${r.frames} frames before it`);if(r.crc!==this.crc)throw new ze("the CRC-32 of the whole stream is wrong")}return r}skip(e){this.frames++,this.drop(e)}drop(e){this.begin+=e,this.offset+=e}}});var al,Xr,ol=_t(()=>{rl();Nt();oi();ch();_h();Hr();al=class extends kr{constructor(e,t){super(e,t,"light_open")}charge(e,t){this.check(this.call("light_charge",e,t))}begin({vertices:e,faces:t,grid:n,lattice:s,corner:r,center:a,scale:o}){let l=[e,t,o,...n,...a,...r.length?r:[0,0,0],...s.length?s:[0,0]];this.lent(8*l.length,c=>{new Float64Array(this.buffer,c).set(l),this.call("light_begin",c)})}faces(e,t){let n=this.given("light_faces",e);return new Int32Array(this.buffer,n,3*t).slice()}decode(e,t,n){return this.given("light_positions",e,t,n)}release(){this.end("light_close")}given(e,t,...n){return this.lent(t.length,s=>(new Uint8Array(this.buffer,s).set(t),this.check(this.call(e,s,t.length,...n))))}check(e){if(!e)throw ri({name:lh(this.call("light_error")),problem:"",place:{}});return e}},Xr=class{constructor(e,t={}){this.queue=[];this.places=0;this.chunks=0;let n={...ai,...t},s=this.light=new al(e,n);this.reader=new Wr(n,s.charge.bind(s))}receiveData(e){this.reader.receiveData(e)}receiveEof(){this.reader.receiveEof()}get position(){return this.reader.position}nextEvent(){for(;;){let e=this.queue.shift();if(e)return e;if(this.error)throw this.error;try{let t=this.reader.nextPacket();if(typeof t=="string")return t;this.accept(t)}catch(t){if(!(t instanceof Tn))throw t;this.error=t.located({offset:this.reader.position})}}}release(){this.light.release()}finish(){for(this.receiveEof();this.nextEvent()!==Ji;);return{positions:this.positions,faces:this.faces,attributes:[]}}get positions(){return this.light.doubles(this.places,3*this.header.vertices)}accept(e){switch(e.type){case"header":return this.header=e.header,this.light.begin(e.header),void this.queue.push(e);case"metadata":return void this.queue.push(e);case"connectivity":return void(this.faces=this.light.faces(e.data,this.header.faces));case"grid":return this.acceptGrid(e.first,e.count,e.data);case"end":this.check(e.positions),this.queue.push({type:"end",missing:new Int32Array(0),degraded:new Int32Array(0)})}}check(e){if(e===void 0)return;let t=this.positions.map(n=>n+0);if(Ki(new Uint8Array(t.buffer))!==e)throw new ze("the checksum of decoded positions is wrong: they are not those that the encoder saw")}acceptGrid(e,t,n){if(e===0){let a={vertices:new Int32Array(0),positions:new Float64Array(0)};this.queue.push({type:"connectivity",faces:this.faces.slice(),vertices:this.header.vertices,loose:a})}this.places=this.light.decode(n,e,t);let s=Int32Array.from({length:t},(a,o)=>e+o),r=this.light.doubles(this.places+24*e,3*t);this.queue.push({type:"block",index:this.chunks++,vertices:s,positions:r,final:new Uint8Array(t).fill(1)})}}});function Ii(i,e,t){if(!t)return new Float32Array(i);let n=new Float32Array(e*t.length);for(let s=0;s<t.length;s++)for(let r=0;r<e;r++)n[e*s+r]=i[e*t[s]+r];return n}var ll=_t(()=>{});function xh(i){let e=new Int32Array(i);for(let t=0;t<i;t++)e[t]=t;return e}function vh(i,e){let t=new Int32Array(e+1);for(let r of i)r>=0&&t[r+1]++;for(let r=0;r<e;r++)t[r+1]+=t[r];let n=new Int32Array(t[e]),s=t.slice();return i.forEach((r,a)=>r>=0&&(n[s[r]++]=a)),{starts:t,members:n}}var bh=_t(()=>{});function Mh(i,e,t,n){let s=[zf,kf].map(p=>t.find(m=>m.name===p&&m.domain==="face"&&m.components===1)),[r,a]=s.map(p=>m=>p?.values[m]??0);s.some(Boolean)&&e.sort((p,m)=>r(p)-r(m)||a(p)-a(m)||p-m);let o=[],l;e.forEach((p,m)=>{l?.part===r(p)&&l.material===a(p)?l.count+=3:o.push(l={part:r(p),material:a(p),start:3*m,count:3})});let c=t.filter(p=>!s.includes(p)),{index:h,vertices:d,rows:u}=Hf(i,e,c,n),f=c.find(({semantic:p,domain:m})=>p==="normal"&&m!=="face"),g=new Map([["position",1],["normal",1]]),b=c.flatMap((p,m)=>{if(p===f)return[];let S=p.semantic==="generic"?p.name:Gf[p.semantic],C=g.get(S)??0;return g.set(S,C+1),[{name:C?`${S}${C}`:S,source:p.name,components:p.components,values:qr(p,u[m])}]});return{index:h,vertices:d,pieces:o,attributes:b,own:f&&qr(f,u[c.indexOf(f)])}}function Vf({domain:i,values:e,components:t,indices:n},s,r){let a=new Int32Array(3*r.length),o=new Map;return r.forEach((l,c)=>{let h=l;if(i==="face"){let d=e.subarray(t*l,t*(l+1)).join();h=o.get(d)??l,o.set(d,h)}for(let d=0;d<3;d++){let u=3*l+d;a[3*c+d]=i==="face"?h:i==="corner"?n?.[u]??0:s[u]}}),a}function Hf(i,e,t,n){let s=new Uint32Array(3*e.length),r=t.filter(({domain:g})=>g!=="vertex");if(r.length===0)return e.forEach((g,b)=>{for(let p=0;p<3;p++)s[3*b+p]=i[3*g+p]}),{index:s,rows:t.map(()=>{})};let a=r.map(g=>Vf(g,i,e)),[o,l]=[new Int32Array(n).fill(-1),new Int32Array(s.length)],[c,h]=[new Int32Array(s.length),new Int32Array(s.length)],d=0;for(let g=0;g<s.length;g++){let b=i[3*e[Math.floor(g/3)]+g%3],p=o[b];for(;p>=0&&!a.every(m=>m[h[p]]===m[g]);)p=l[p];p<0&&(p=d++,[l[p],o[b],c[p],h[p]]=[o[b],p,b,g]),s[g]=p}let u=c.slice(0,d),f=t.map(g=>{let b=a[r.indexOf(g)];return b?h.subarray(0,d).map(p=>b[p]):u});return{index:s,vertices:u,rows:f}}function qr({semantic:i,kind:e,components:t,values:n},s){let r=i==="color"?{uint8:255,uint16:65535}[e]??1:1,a=Ii(n,t,s);if(r>1)for(let o=0;o<a.length;o++)a[o]/=r;return a}var kf,zf,Gf,Sh=_t(()=>{ll();[kf,zf]=["material","part"],Gf={texcoord:"uv",color:"color",normal:"normal"}});function wh(i,e,t){let n=new Float32Array(t.length);for(let s=0;s<i.length;s+=3){if(e[i[s]]<0||e[i[s+1]]<0||e[i[s+2]]<0)continue;let r=3*i[s],a=3*i[s+1],o=3*i[s+2],l=t[a]-t[r],c=t[a+1]-t[r+1],h=t[a+2]-t[r+2],d=t[o]-t[r],u=t[o+1]-t[r+1],f=t[o+2]-t[r+2],g=c*f-h*u,b=h*d-l*f,p=l*u-c*d;n[r]+=g,n[r+1]+=b,n[r+2]+=p,n[a]+=g,n[a+1]+=b,n[a+2]+=p,n[o]+=g,n[o+1]+=b,n[o+2]+=p}for(let s=0;s<n.length;s+=3){let r=Math.sqrt(n[s]*n[s]+n[s+1]*n[s+1]+n[s+2]*n[s+2])||1;n[s]/=r,n[s+1]/=r,n[s+2]/=r}return n}function qf(i){let[e,t]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let o=0;o<i.length;o+=3)for(let l=0;l<3;l++)i[o+l]<e[l]&&(e[l]=i[o+l]),i[o+l]>t[l]&&(t[l]=i[o+l]);let[n,s,r]=e.map((o,l)=>(o+t[l])/2),a=0;for(let o=0;o<i.length;o+=3)a=Math.max(a,(i[o]-n)**2+(i[o+1]-s)**2+(i[o+2]-r)**2);return{center:[n,s,r],radius:Math.sqrt(a),low:e,high:t}}var Wf,Xf,Yr,Eh=_t(()=>{ll();oi();bh();Sh();Wf=30,Xf=32767,Yr=class{constructor(e,t,n){this.growing=e;this.show=n;this.faces=new Int32Array(0);this.points=new Float32Array(0);this.normals=new Float32Array(0);this.origin=new Int32Array(0);this.refined=new Uint8Array(0);this.waiting=new Uint8Array(0);this.around={starts:new Int32Array(1),members:new Int32Array(0)};this.touched=[];this.isTouched=new Uint8Array(0);this.drawable=[];this.blocks=0;this.shown=0;this.carried=[];this.kept=0;this.run=0;this.limits={...ai,...t}}accept(e){switch(e.type){case"header":return e.header.run>0?this.turn(e.header.run):this.show(e);case"connectivity":return this.begin(e);case"block":case"refinement":return this.grow(e);case"attribute":return this.carried.push(e),this.run>0?void 0:this.show({type:"attribute",name:e.name,semantic:e.semantic,domain:e.domain});case"frame":return this.addFrame(e);case"loss":return this.flush(),this.show(e);case"end":return this.flush(),e.positions&&this.take(e.positions),this.shape||this.finish(),this.show({...e,positions:void 0});default:return this.show(e)}}turn(e){this.flush(),[this.run,this.growing]=[e,!1],this.faces=new Int32Array(0),[this.points,this.normals,this.origin]=[new Float32Array(0),new Float32Array(0),new Int32Array(0)],[this.carried.length,this.shape]=[0,void 0]}flush(){if(!this.growing||this.touched.length+this.drawable.length===0)return;let e=Int32Array.from(this.touched);this.touched=[];let[t,n]=[new Float32Array(3*e.length),new Float32Array(3*e.length)],[s,r]=[new Int32Array(e.length),new Uint8Array(e.length)];e.forEach((o,l)=>{this.isTouched[o]=0,this.renewNormal(o);for(let c=0;c<3;c++)t[3*l+c]=this.points[3*o+c],n[3*l+c]=this.normals[3*o+c];s[l]=this.origin[o],r[l]=this.refined[o]});let a=this.cornersOf(this.drawable);this.drawable=[],this.shown=performance.now(),this.show({type:"grown",vertices:e,positions:t,normals:n,origin:s,refined:r,index:a,blocks:this.blocks},[e,t,n,s,r,a].map(({buffer:o})=>o))}begin({faces:e,vertices:t,loose:n}){this.faces=e,this.origin=new Int32Array(t).fill(-1),this.points=new Float32Array(3*t),this.normals=new Float32Array(3*t),n.vertices.forEach((s,r)=>this.points.set(n.positions.subarray(3*r,3*r+3),3*s)),this.growing&&(this.show({type:"begun",vertices:t,corners:e.length,loose:n}),this.refined=new Uint8Array(t),this.isTouched=new Uint8Array(t),this.waiting=new Uint8Array(e.length/3).fill(3),this.around=vh(e,t))}touch(e){this.isTouched[e]||(this.isTouched[e]=1,this.touched.push(e))}grow(e){let{vertices:t,positions:n}=e,{points:s,origin:r,growing:a}=this;for(let o=0;o<t.length;o++){let l=t[o];for(let c=0;c<3;c++)s[3*l+c]=n[3*o+c];a?this.settle(l):r[l]=this.blocks}if(e.type==="block")this.blocks++;else if(a)for(let o of t)this.refined[o]=1;a&&performance.now()-this.shown>Wf&&this.flush()}settle(e){let{faces:t,waiting:n,origin:s}=this,{starts:r,members:a}=this.around,o=s[e]<0;o&&(s[e]=this.blocks),this.touch(e);for(let l=r[e];l<r[e+1];l++){let c=Math.floor(a[l]/3);o&&--n[c]===0&&this.drawable.push(c);for(let h=3*c;h<3*c+3;h++)this.touch(t[h])}}renewNormal(e){let{faces:t,waiting:n,normals:s,points:r}=this,{starts:a,members:o}=this.around,[l,c,h]=[0,0,0];for(let u=a[e];u<a[e+1];u++){let f=Math.floor(o[u]/3);if(n[f]>0)continue;let g=3*t[3*f],b=3*t[3*f+1],p=3*t[3*f+2],[m,S,C]=[r[b]-r[g],r[b+1]-r[g+1],r[b+2]-r[g+2]],[E,P,R]=[r[p]-r[g],r[p+1]-r[g+1],r[p+2]-r[g+2]];l+=S*R-C*P,c+=C*E-m*R,h+=m*P-S*E}let d=Math.sqrt(l*l+c*c+h*h)||1;s[3*e]=l/d,s[3*e+1]=c/d,s[3*e+2]=h/d}cornersOf(e){let t=new Uint32Array(3*e.length);for(let n=0;n<t.length;n++)t[n]=this.faces[3*e[Math.floor(n/3)]+n%3];return t}take(e){this.points=new Float32Array(e),this.origin.fill(0)}addFrame({index:e,positions:t,attributes:n}){this.kept+=18*(t.length/3)+n.reduce((d,{values:u})=>d+4*u.length,0),Rn(this.limits,"keptBytes",this.kept),this.shape||(this.take(t),this.finish());let{vertices:s,attributes:r}=this.shape,a=Ii(t,3,s),o=Ii(wh(this.faces,this.origin,t),3,s),l=new Int16Array(o.length);for(let d=0;d<l.length;d++)l[d]=Math.round(o[d]*Xf);let c=n.flatMap(d=>{let u=r.find(({source:f})=>f===d.name);return u?[{...u,values:qr(d,s)}]:[]}),h=[a,l,...c.map(({values:d})=>d)].map(({buffer:d})=>d);this.show({type:"frame",index:e,positions:a,normals:l,attributes:c},h)}finish(){this.flush(),this.growing=!1;let{faces:e,origin:t,points:n,carried:s}=this,r=m=>t[e[m]]>=0,a=xh(e.length/3),o=t.includes(-1)?a.filter(m=>r(3*m)&&r(3*m+1)&&r(3*m+2)):a,{index:l,vertices:c,pieces:h,attributes:d,own:u}=s.length>0?Mh(e,o,s,n.length/3):this.bare(o),f=Ii(n,3,c),g=u??Ii(wh(e,t,n),3,c),b=this.shape={index:l,positions:f,normals:g,attributes:d,vertices:c,pieces:h,...qf(f)},p=[l,f,g,...d.map(({values:m})=>m)].map(({buffer:m})=>m);this.run>0&&(this.kept+=p.reduce((m,{byteLength:S})=>m+S,0)),this.show({type:"whole",shape:b,run:this.run},p)}bare(e){let t=3*e.length===this.faces.length?new Uint32Array(this.faces):this.cornersOf(e);return{index:t,pieces:t.length>0?[{part:0,material:0,start:0,count:t.length}]:[],attributes:[]}}}});function Ah(i,e,t,n=new Ri(e.kernels)){let s=!1,r,a=()=>{s||r?.close(),s=!0},o=c=>{if(!s)try{c()}catch(h){a(),t(h instanceof Tn?{problem:h.described}:{fault:`${h}`})}},l=(c,h)=>{s||(("over"in c||"through"in c)&&a(),t(c,h))};return o(()=>r=i(e,n,l,o)),{take:c=>o(()=>r?.take(c)),stop:a}}function Th(i,e,t={}){let n=new Map;i.onmessage=({data:s})=>{if("help"in s)return Th(s.help,e,t);let{task:r}=s;"start"in s?(t.kernels??=new Ri(s.start.kernels),n.set(r,Ah(e,s.start,(a,o=[])=>i.postMessage({task:r,...a},o),t.kernels))):"stop"in s?(n.get(r)?.stop(),n.delete(r)):n.get(r)?.take(s.data)}}function Rh(i){return{openDesk:(e,t)=>Ah(i,e,t),serve(){let e=self;Th(e,i),e.postMessage({ready:!0},[])}}}var $r,Ch=_t(()=>{Eh();Nt();sl();Hr();$r=class{constructor(e,t,n){this.decoder=e;this.start=t;this.out=n;this.taken=0;let{drawing:s,limits:r,reported:a=0}=t;this.reported=-a,s&&(this.drawing=new Yr(s==="growing",r,(o,l)=>this.say({picture:o},l)))}take(e){e?this.decoder.receiveData(e):this.decoder.receiveEof(),this.taken+=e?.length??0}close(){this.decoder.release()}report(){try{return this.pass()}catch(e){throw this.drawing?.flush(),this.out({reported:this.reported}),e}}pass(){for(;;){let e=this.decoder.nextEvent();if(typeof e=="string")return this.drawing?.flush(),e===Pi&&this.say({taken:this.taken}),e===Ji&&this.say({over:!0}),e;if(this.drawing)this.drawing.accept(e);else if(e.type==="frame"){let t=Float32Array.from(e.positions);this.say({event:{...e,positions:t}},[t.buffer])}else this.say({event:e});this.reported<0&&this.drawing?.flush(),(e.type!=="block"||this.start.drawing!=="whole")&&this.reported++}}say(e,t){this.reported>=0&&this.out(e,t)}}});var Ph,Ih,Lh=_t(()=>{Ch();ol();({openDesk:Ph,serve:Ih}=Rh((i,e,t)=>{let n=new $r(new Xr(e,i.limits),i,t);return{close:()=>n.close(),take(s){n.take(s),n.report()}}}))});var Dh={};Yc(Dh,{BsmError:()=>Tn,CorruptError:()=>ze,DEFAULT_LIMITS:()=>ai,FormatError:()=>Nr,Helper:()=>Kc,Kernels:()=>Ri,LimitError:()=>Ai,NEED_BLOCK:()=>Jc,NumericError:()=>jc,TruncatedError:()=>Ur,UnsupportedError:()=>Ti,bsm:()=>Dr,checkLimit:()=>Qc,errorLike:()=>ri,hasVectors:()=>Wn,openDesk:()=>Ph,serve:()=>Ih});var Nh=_t(()=>{Nt();oi();sl();Us();ol();Lh()});Nt();Yi();Nt();Or();Br();function rh(i){try{let e=Zi(i,Hn.length,i.length);if(!e)return;let t=e.end+Math.floor(e.value/16);if(t>i.length)return i[0]===Hn[0]&&e.value%16===1?void 0:{build:"whole",vertices:0};let n=new Map($i(i.subarray(e.end,t)).map(([u,f])=>[Number(u.value),f.type==="array"?f.value[0]:f])),s=u=>Number(n.get(u)?.value??0),{vertices:r,paper:a,sequence:o,attributes:l,light:c}=ih;return{build:s(a)>0||n.has(l)?"whole":n.has(o)?"moving":s(c)===1?"quick":"small",vertices:s(r)}}catch(e){if(!(e instanceof Tn))throw e;return{build:"whole",vertices:0}}}Us();var Yf={whole:()=>new Worker(new URL("./worker.js",import.meta.url),{type:"module",name:"BSM"}),small:()=>new Worker(new URL("./small-worker.js",import.meta.url),{type:"module",name:"BSM-small"}),quick:()=>new Worker(new URL("./quick-worker.js",import.meta.url),{type:"module",name:"BSM-quick"}),moving:()=>new Worker(new URL("./moving-worker.js",import.meta.url),{type:"module",name:"BSM-moving"})},$f={whole:()=>new URL("./kernels.wasm",import.meta.url),small:()=>new URL("./small.wasm",import.meta.url),quick:()=>new URL("./quick.wasm",import.meta.url),moving:()=>new URL("./moving.wasm",import.meta.url),scalar:()=>new URL("./kernels-scalar.wasm",import.meta.url)};function Zf(i){return Wn()?i:"whole"}function Kf(i){try{return i()}catch{throw new Error("this bundle does not know where the decoder's files are: copy those of bsm-decoder/built, and name their folder with setDecoderPath")}}function Jf(i){if(!(typeof Worker>"u"))try{return i()}catch{return}}var cl="the server sent an HTML page; is the address right?";function hl(i){return/^\s*<(!|html)/i.test(new TextDecoder().decode(i.subarray(0,64)))}async function jf(i){if(i.protocol==="file:"){let{readFile:n}=process.getBuiltinModule("node:fs/promises");return WebAssembly.compile(await n(i))}let e=await fetch(i);if(!e.ok)throw new Error(`${i}: ${e.status} ${e.statusText}; the decoder's files must lie there`);let t=await e.arrayBuffer();return WebAssembly.compile(t).catch(n=>{throw new Error(`${i}: ${hl(new Uint8Array(t))?cl:n.message}`)})}function ul(i){let e=new Map;return t=>{let n=e.get(t)??i(t);return e.set(t,n),n.catch(()=>e.delete(t)),n}}var Qf=i=>i==="quick"&&Wn()?Promise.resolve().then(()=>(Nh(),Dh)):Promise.resolve().then(()=>(Nt(),eh)),Uh={worker:i=>Jf(Yf[Zf(i)]),kernels:ul(async i=>jf(Kf($f[Wn()?i:"scalar"]))),local:Qf};Us();var tp=4,np=1,Fs=class{constructor(e=Uh,t=tp){this.source=e;this.limit=t;this.hands=[];this.streams=new Set;this.waiting=[];this.task=0;this.failed=0;this.alone=!1}setLimit(e){this.limit=Math.max(1,e)}async preload(e="small"){!this.alone&&!this.hands.some(t=>t.build===e)&&this.start(e),await this.source.kernels(e)}open(e,t={}){let n=new dl(e,t,s=>{this.begin(n,s)},()=>this.end(n));return this.streams.add(n),n}dispose(){for(let{worker:e}of this.hands.splice(0))e.terminate();this.waiting.length=0;for(let e of[...this.streams])e.fail(new Error("the decoder's threads were stopped"))}async begin(e,t){let n;try{n=await this.source.kernels(t.build)}catch(s){return e.fail(s instanceof Error?s:new Error(`${s}`))}e.prepare(n,t),e.closed||this.place(e)}place(e){let{build:t}=e.need,n=this.alone?void 0:this.free(t);if(this.alone)return void this.stay(e);if(!n)return void this.waiting.push(e);n.streams.add(e);let s=this.helpersFor(e,n);e.task=this.task++;let r=s.map(a=>{let{port1:o,port2:l}=new MessageChannel;return a.worker.postMessage({help:l},[l]),o});e.work((a,o)=>n.worker.postMessage(a,o),r)}free(e){let t=this.hands.filter(s=>s.streams.size===0),n=t.find(s=>s.build===e);if(n)return n;if(this.hands.length>=this.limit){if(t.length===0)return;this.hands.splice(this.hands.indexOf(t[0]),1),t[0].worker.terminate()}return this.start(e)}helpersFor(e,t){let{need:n,wishes:s}=e,r=Math.min(ah(),this.limit)-1;if(n.build==="quick"||n.vertices<(s.worthwhile??8192)||this.waiting.length>0)return[];let a=this.hands.filter(l=>l!==t&&l.streams.size>0).length,o=[];for(;o.length<r-a;){let l=this.free(n.build);if(!l)break;l.streams.add(e),o.push(l)}return o}start(e){let t=this.source.worker(e);if(!t)return void this.settle();let n={build:e,worker:t,ready:!1,streams:new Set};return t.onmessage=({data:s})=>{if("ready"in s)[n.ready,this.failed]=[!0,0];else for(let r of n.streams)r.task===s.task&&r.hear(s)},t.onerror=s=>{s.preventDefault?.(),this.lose(n,new Error(`the decoder's thread does not run: ${s.message??"it was stopped"}`))},this.hands.push(n),n}settle(){!this.alone&&typeof Worker<"u"&&console.warn("BSM: this page may have no threads of its own, it decodes in the one that draws"),this.alone=!0}lose(e,t){let n=[...e.streams];e.worker.terminate(),e.streams.clear(),this.hands.includes(e)&&this.hands.splice(this.hands.indexOf(e),1);for(let s of this.hands)for(let r of n)s.streams.delete(r);!e.ready&&++this.failed>np&&this.settle();for(let s of n)(e.ready||s.begun)&&s.fail(t);if(!e.ready)for(let s of[...n,...this.waiting.splice(0)])s.closed||this.place(s)}async stay(e){let t=e.task=this.task++,n=await this.source.local(e.need.build).catch(a=>e.fail(new Error(`${a}`))),s,r=a=>e.task===t?e.hear(a):void 0;e.work(a=>{setTimeout(()=>{e.closed||"stop"in a?s?.stop():"start"in a?s=n?.openDesk({...a.start,helpers:[]},r):"data"in a&&s?.take(a.data)})},[])}end(e){e.closed&&this.streams.delete(e);let t=this.hands.filter(r=>r.streams.delete(e));this.hands.push(...this.hands.splice(0).filter(r=>!t.includes(r)),...t);let n=this.waiting.indexOf(e);n>=0&&this.waiting.splice(n,1);let s=()=>this.hands.length<this.limit||this.hands.some(({streams:r})=>r.size===0);for(let r;s()&&(r=this.waiting.shift());)this.place(r)}},dl=class{constructor(e,t,n,s){this.listener=e;this.wishes=t;this.begin=n;this.end=s;this.closed=!1;this.begun=!1;this.task=-1;this.need={build:"whole",vertices:0};this.pieces=[];this.known=!1;this.reported=0}receiveData(e){this.take(e)}receiveEof(){this.take(null)}close(){this.closed||(this.closed=!0,this.say?.({task:this.task,stop:!0},[]),this.pieces.length=0,this.end())}fail(e){this.closed||(this.close(),this.listener.onError(e))}prepare(e,t){[this.kernels,this.need]=[e,t]}work(e,t){let{tolerant:n,drawing:s,worthwhile:r,limits:a={}}=this.wishes,{kernels:o,reported:l}=this;if(!(!o||this.closed)){this.say=e,e({task:this.task,start:{kernels:o,limits:a,tolerant:n,drawing:s,reported:l,worthwhile:r,helpers:t}},t);for(let c of this.pieces)e({task:this.task,data:c},[])}}hear(e){let{listener:t}=this;this.closed||(this.begun=!0,"picture"in e?t.onPicture?.(e.picture):"event"in e?t.onEvent?.(e.event):"taken"in e?t.onTaken?.(e.taken):"reported"in e?this.reported=e.reported:"problem"in e?this.need.build!=="whole"?this.restart():this.fail(ri(hl(Fh(this.pieces.slice(0,64)))?{...e.problem,problem:cl,place:{}}:e.problem)):"fault"in e?this.fail(new Error(e.fault)):"over"in e&&(this.close(),t.onEnd?.()))}take(e){if(!this.closed){if(this.pieces.push(e),this.say)this.say({task:this.task,data:e},[]);else if(!this.known){let t=this.wishes.tolerant?{build:"whole",vertices:0}:rh(Fh(this.pieces));this.known=t!==void 0||e===null,this.known&&this.begin(t??this.need)}}}restart(){this.say?.({task:this.task,stop:!0},[]),[this.say,this.task]=[void 0,-1],this.end(),this.begin({...this.need,build:"whole"})}};function Fh(i){let e=i.flatMap(s=>s??[]);if(e.length===1)return e[0];let t=new Uint8Array(e.reduce((s,{length:r})=>s+r,0)),n=0;for(let s of e)t.set(s,n),n+=s.length;return t}Nt();Us();var Os=KERNELS.encoder?.url,Oh=KERNELS.kernels.url!==void 0&&!Os;async function Zr(i,e){let t=await fetch(i,e);if(!t.ok)throw new Error(`${t.status} ${t.statusText}`);return t}async function Xn({url:i,data:e,bytes:t}){return t?t.slice():e!==void 0?Uint8Array.from(atob(e),n=>n.charCodeAt(0)):new Uint8Array(await(await Zr(i)).arrayBuffer())}var ip=ul(async i=>WebAssembly.compile(await Xn(i==="small"&&KERNELS.small||KERNELS[Wn()?"kernels":"kernels-scalar"]))),fl={worker(){let i=URL.createObjectURL(new Blob([`(${Dr})().serve()`],{type:"text/javascript"}));try{return new Worker(i,{name:"BSM"})}catch{return}finally{URL.revokeObjectURL(i)}},kernels:i=>ip(i==="small"&&Wn()&&KERNELS.small?i:"whole"),local:()=>Promise.resolve({openDesk:el})};var Bs=({name:i})=>/\.bsm$/i.test(i),pl=async i=>new Uint8Array(await i.arrayBuffer());function ml(i,e,t){let n=i.length-1,s=(r,a)=>a<n?"Original":/[^.]*$/.exec(r)[0].toUpperCase();return{name:i[n].name,main:n,facts:t,layers:i.map(({name:r,size:a},o)=>({title:s(r,o),detail:n>0?r:"",size:a,bytes:e[o]}))}}var Kr=class{constructor(e,t,n){this.form=e;this.show=t;this.encode=n;this.working=new AbortController;let{root:s}=e;e.on("cancel","click",()=>this.cancel()),e.on("file","change",({files:a})=>a?.length&&void this.take([...a]));let r=e.part("drop");s.addEventListener("dragover",a=>{a.preventDefault(),r.hidden=!1}),s.addEventListener("dragleave",a=>r.hidden=!a.relatedTarget||!s.contains(a.relatedTarget)),s.addEventListener("drop",a=>{a.preventDefault(),r.hidden=!0;let o=[...a.dataTransfer?.files??[]];o.length>0&&this.take(o)})}cancel(){this.working.abort()}async take(e){let{form:t}=this;this.cancel();let{signal:n}=this.working=new AbortController,s=e.map(({name:r})=>r).join(" and ");t.say("problem","");try{if(e.length>2)throw new Error("Open one file, or two to compare them.");Bs(e[0])&&!e.every(Bs)&&e.reverse();let a=e.every(Bs)&&(e.length===1||!this.encode)?ml(e,await Promise.all(e.map(pl)),{}):await this.encoded(e,n),o=await Xn(a.layers[a.main]);n.aborted||this.show(a,o)}catch(r){n.aborted||t.say("problem",`${s} cannot be shown. ${r instanceof Error?r.message:r}`)}finally{this.working.signal===n&&(t.part("work").hidden=!0,t.part("invite").hidden=t.root.dataset.state!=="empty")}}encoded(e,t){let{form:n}=this;if(!this.encode)throw new Error(`This page opens only .bsm files. To view this mesh, run: bsm view ${e[1]?.name??e[0].name}${e[1]?` --original ${e[0].name}`:""}`);[n.part("invite").hidden,n.part("work").hidden]=[!0,!1];let s=n.root.querySelector("progress"),r=(a,o)=>{n.say("stage",`${e.map(({name:l})=>l).join(" and ")}: ${a}`),o>0?s.value=o:s.removeAttribute("value")};return r("sending",0),this.encode(e,n.control("preset").value,r,t)}};Nt();var xi={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},vi={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},lu=0,Hl=1,cu=2;var dr=1,hu=2,Ss=3,Fn=0,qt=1,Jt=2,zi=0,ws=1,Wl=2,Xl=3,ql=4,uu=5;var Gi=100,du=101,fu=102,pu=103,mu=104,gu=200,yu=201,_u=202,xu=203,Yl=204,$l=205,vu=206,bu=207,Mu=208,Su=209,wu=210,Eu=211,Au=212,Tu=213,Ru=214,xa=0,va=1,ba=2,ds=3,Ma=4,Sa=5,wa=6,Ea=7,Zl=0,Cu=1,Pu=2,On=0,Kl=1,Jl=2,jl=3,Ql=4,ec=5,tc=6,fr=7;var nc=300,Vi=301,Es=302,As=303,Ya=304,fs=1e3,In=1001,Aa=1002,Lt=1003,Iu=1004;var pr=1005;var Et=1006,$a=1007;var ni=1008;var jt=1009,ic=1010,sc=1011,Ts=1012,Za=1013,bn=1014,Mn=1015,hn=1016,Ka=1017,Ja=1018,Hi=1020,rc=35902,ac=35899,oc=1021,lc=1022,Sn=1023,Qn=1026,ii=1027,cc=1028,ja=1029,bi=1030,Qa=1031;var eo=1033,mr=33776,gr=33777,yr=33778,_r=33779,to=35840,no=35841,io=35842,so=35843,ro=36196,ao=37492,oo=37496,lo=37488,co=37489,xr=37490,ho=37491,uo=37808,fo=37809,po=37810,mo=37811,go=37812,yo=37813,_o=37814,xo=37815,vo=37816,bo=37817,Mo=37818,So=37819,wo=37820,Eo=37821,Ao=36492,To=36494,Ro=36495,Co=36283,Po=36284,vr=36285,Io=36286;var qs=2300,Ta=2301,ya=2302,Fl=2303,Ol=2400,Bl=2401,kl=2402;var Lu=3200;var Lo=0,Du=1,wn="",kt="srgb",Ys="srgb-linear",$s="linear",it="srgb";var _a=7680;var Nu=519,Uu=512,Fu=513,Ou=514,hc=515,Bu=516,ku=517,uc=518,dc=519,zu=35044;var fc="300 es",fn=2e3,ps=2001;function sp(i){for(let e=i.length-1;e>=0;--e)if(i[e]>=65535)return!0;return!1}function rp(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function Zs(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function Gu(){let i=Zs("canvas");return i.style.display="block",i}var Bh={},ms=null;function pc(...i){let e="THREE."+i.shift();ms?ms("log",e,...i):console.log(e,...i)}function Vu(i){let e=i[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=i[1];t&&t.isStackTrace?i[0]+=" "+t.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function De(...i){i=Vu(i);let e="THREE."+i.shift();if(ms)ms("warn",e,...i);else{let t=i[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...i)}}function Fe(...i){i=Vu(i);let e="THREE."+i.shift();if(ms)ms("error",e,...i);else{let t=i[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...i)}}function Hs(...i){let e=i.join(" ");e in Bh||(Bh[e]=!0,De(...i))}function Hu(i,e,t){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(e,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:n()}}setTimeout(r,t)})}var Wu={[xa]:xa,[ba]:wa,[Ma]:Ma,[ds]:Sa,[va]:va,[wa]:ba,[Ea]:Ea,[Sa]:ds},rn=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n===void 0?!1:n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let s=n[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let s=n.slice(0);for(let r=0,a=s.length;r<a;r++)s[r].call(this,e);e.target=null}}},Ot=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],kh=1234567,Ws=Math.PI/180,gs=180/Math.PI;function Rs(){let i=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(Ot[i&255]+Ot[i>>8&255]+Ot[i>>16&255]+Ot[i>>24&255]+"-"+Ot[e&255]+Ot[e>>8&255]+"-"+Ot[e>>16&15|64]+Ot[e>>24&255]+"-"+Ot[t&63|128]+Ot[t>>8&255]+"-"+Ot[t>>16&255]+Ot[t>>24&255]+Ot[n&255]+Ot[n>>8&255]+Ot[n>>16&255]+Ot[n>>24&255]).toLowerCase()}function Xe(i,e,t){return Math.max(e,Math.min(t,i))}function mc(i,e){return(i%e+e)%e}function ap(i,e,t,n,s){return n+(i-e)*(s-n)/(t-e)}function op(i,e,t){return i!==e?(t-i)/(e-i):0}function Xs(i,e,t){return(1-t)*i+t*e}function lp(i,e,t,n){return Xs(i,e,1-Math.exp(-t*n))}function cp(i,e=1){return e-Math.abs(mc(i,e*2)-e)}function hp(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*(3-2*i))}function up(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*i*(i*(i*6-15)+10))}function dp(i,e){return i+Math.floor(Math.random()*(e-i+1))}function fp(i,e){return i+Math.random()*(e-i)}function pp(i){return i*(.5-Math.random())}function mp(i){i!==void 0&&(kh=i);let e=kh+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function gp(i){return i*Ws}function yp(i){return i*gs}function _p(i){return i>0&&Number.isInteger(i)&&2**Math.round(Math.log2(i))===i}function xp(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function gc(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function vp(i,e,t,n,s){let r=Math.cos,a=Math.sin,o=r(t/2),l=a(t/2),c=r((e+n)/2),h=a((e+n)/2),d=r((e-n)/2),u=a((e-n)/2),f=r((n-e)/2),g=a((n-e)/2);switch(s){case"XYX":i.set(o*h,l*d,l*u,o*c);break;case"YZY":i.set(l*u,o*h,l*d,o*c);break;case"ZXZ":i.set(l*d,l*u,o*h,o*c);break;case"XZX":i.set(o*h,l*g,l*f,o*c);break;case"YXY":i.set(l*f,o*h,l*g,o*c);break;case"ZYZ":i.set(l*g,l*f,o*h,o*c);break;default:De("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function yc(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function Xu(i,e){if(e.constructor===Float32Array)return i;let t=yc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/t,-1)}function qu(i,e){if(e.constructor===Float32Array)return i;let t=yc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*t)}var En={DEG2RAD:Ws,RAD2DEG:gs,generateUUID:Rs,clamp:Xe,euclideanModulo:mc,mapLinear:ap,inverseLerp:op,lerp:Xs,damp:lp,pingpong:cp,smoothstep:hp,smootherstep:up,randInt:dp,randFloat:fp,randFloatSpread:pp,seededRandom:mp,degToRad:gp,radToDeg:yp,isPowerOfTwo:_p,ceilPowerOfTwo:xp,floorPowerOfTwo:gc,setQuaternionFromProperEuler:vp,normalize:qu,denormalize:Xu},Oe=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,s=e.elements;return this.x=s[0]*t+s[3]*n+s[6],this.y=s[1]*t+s[4]*n+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=Xe(this.x,e.x,t.x),this.y=Xe(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=Xe(this.x,e,t),this.y=Xe(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Xe(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(Xe(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),s=Math.sin(t),r=this.x-e.x,a=this.y-e.y;return this.x=r*n-a*s+e.x,this.y=r*s+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},an=class{constructor(e=0,t=0,n=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=s}static slerpFlat(e,t,n,s,r,a,o){let l=n[s+0],c=n[s+1],h=n[s+2],d=n[s+3],u=r[a+0],f=r[a+1],g=r[a+2],b=r[a+3];if(d!==b||l!==u||c!==f||h!==g){let p=l*u+c*f+h*g+d*b;p<0&&(u=-u,f=-f,g=-g,b=-b,p=-p);let m=1-o;if(p<.9995){let S=Math.acos(p),C=Math.sin(S);m=Math.sin(m*S)/C,o=Math.sin(o*S)/C,l=l*m+u*o,c=c*m+f*o,h=h*m+g*o,d=d*m+b*o}else{l=l*m+u*o,c=c*m+f*o,h=h*m+g*o,d=d*m+b*o;let S=1/Math.sqrt(l*l+c*c+h*h+d*d);l*=S,c*=S,h*=S,d*=S}}e[t]=l,e[t+1]=c,e[t+2]=h,e[t+3]=d}static multiplyQuaternionsFlat(e,t,n,s,r,a){let o=n[s],l=n[s+1],c=n[s+2],h=n[s+3],d=r[a],u=r[a+1],f=r[a+2],g=r[a+3];return e[t]=o*g+h*d+l*f-c*u,e[t+1]=l*g+h*u+c*d-o*f,e[t+2]=c*g+h*f+o*u-l*d,e[t+3]=h*g-o*d-l*u-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,s){return this._x=e,this._y=t,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,s=e._y,r=e._z,a=e._order,o=Math.cos,l=Math.sin,c=o(n/2),h=o(s/2),d=o(r/2),u=l(n/2),f=l(s/2),g=l(r/2);switch(a){case"XYZ":this._x=u*h*d+c*f*g,this._y=c*f*d-u*h*g,this._z=c*h*g+u*f*d,this._w=c*h*d-u*f*g;break;case"YXZ":this._x=u*h*d+c*f*g,this._y=c*f*d-u*h*g,this._z=c*h*g-u*f*d,this._w=c*h*d+u*f*g;break;case"ZXY":this._x=u*h*d-c*f*g,this._y=c*f*d+u*h*g,this._z=c*h*g+u*f*d,this._w=c*h*d-u*f*g;break;case"ZYX":this._x=u*h*d-c*f*g,this._y=c*f*d+u*h*g,this._z=c*h*g-u*f*d,this._w=c*h*d+u*f*g;break;case"YZX":this._x=u*h*d+c*f*g,this._y=c*f*d+u*h*g,this._z=c*h*g-u*f*d,this._w=c*h*d-u*f*g;break;case"XZY":this._x=u*h*d-c*f*g,this._y=c*f*d-u*h*g,this._z=c*h*g+u*f*d,this._w=c*h*d+u*f*g;break;default:De("Quaternion: .setFromEuler() encountered an unknown order: "+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,s=Math.sin(n);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],s=t[4],r=t[8],a=t[1],o=t[5],l=t[9],c=t[2],h=t[6],d=t[10],u=n+o+d;if(u>0){let f=.5/Math.sqrt(u+1);this._w=.25/f,this._x=(h-l)*f,this._y=(r-c)*f,this._z=(a-s)*f}else if(n>o&&n>d){let f=2*Math.sqrt(1+n-o-d);this._w=(h-l)/f,this._x=.25*f,this._y=(s+a)/f,this._z=(r+c)/f}else if(o>d){let f=2*Math.sqrt(1+o-n-d);this._w=(r-c)/f,this._x=(s+a)/f,this._y=.25*f,this._z=(l+h)/f}else{let f=2*Math.sqrt(1+d-n-o);this._w=(a-s)/f,this._x=(r+c)/f,this._y=(l+h)/f,this._z=.25*f}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(Xe(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let s=Math.min(1,t/n);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,s=e._y,r=e._z,a=e._w,o=t._x,l=t._y,c=t._z,h=t._w;return this._x=n*h+a*o+s*c-r*l,this._y=s*h+a*l+r*o-n*c,this._z=r*h+a*c+n*l-s*o,this._w=a*h-n*o-s*l-r*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,s=e._y,r=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,s=-s,r=-r,a=-a,o=-o);let l=1-t;if(o<.9995){let c=Math.acos(o),h=Math.sin(c);l=Math.sin(l*c)/h,t=Math.sin(t*c)/h,this._x=this._x*l+n*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+a*t,this._onChangeCallback()}else this._x=this._x*l+n*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},k=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(zh.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(zh.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6]*s,this.y=r[1]*t+r[4]*n+r[7]*s,this.z=r[2]*t+r[5]*n+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=e.elements,a=1/(r[3]*t+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*n+r[8]*s+r[12])*a,this.y=(r[1]*t+r[5]*n+r[9]*s+r[13])*a,this.z=(r[2]*t+r[6]*n+r[10]*s+r[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,s=this.z,r=e.x,a=e.y,o=e.z,l=e.w,c=2*(a*s-o*n),h=2*(o*t-r*s),d=2*(r*n-a*t);return this.x=t+l*c+a*d-o*h,this.y=n+l*h+o*c-r*d,this.z=s+l*d+r*h-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*n+r[8]*s,this.y=r[1]*t+r[5]*n+r[9]*s,this.z=r[2]*t+r[6]*n+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=Xe(this.x,e.x,t.x),this.y=Xe(this.y,e.y,t.y),this.z=Xe(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=Xe(this.x,e,t),this.y=Xe(this.y,e,t),this.z=Xe(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Xe(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,s=e.y,r=e.z,a=t.x,o=t.y,l=t.z;return this.x=s*l-r*o,this.y=r*a-n*l,this.z=n*o-s*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return gl.copy(this).projectOnVector(e),this.sub(gl)}reflect(e){return this.sub(gl.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(Xe(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,s=this.z-e.z;return t*t+n*n+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let s=Math.sin(t)*e;return this.x=s*Math.sin(n),this.y=Math.cos(t)*e,this.z=s*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},gl=new k,zh=new an,ke=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,s,r,a,o,l,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,a,o,l,c)}set(e,t,n,s,r,a,o,l,c){let h=this.elements;return h[0]=e,h[1]=s,h[2]=o,h[3]=t,h[4]=r,h[5]=l,h[6]=n,h[7]=a,h[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,a=n[0],o=n[3],l=n[6],c=n[1],h=n[4],d=n[7],u=n[2],f=n[5],g=n[8],b=s[0],p=s[3],m=s[6],S=s[1],C=s[4],E=s[7],P=s[2],R=s[5],_=s[8];return r[0]=a*b+o*S+l*P,r[3]=a*p+o*C+l*R,r[6]=a*m+o*E+l*_,r[1]=c*b+h*S+d*P,r[4]=c*p+h*C+d*R,r[7]=c*m+h*E+d*_,r[2]=u*b+f*S+g*P,r[5]=u*p+f*C+g*R,r[8]=u*m+f*E+g*_,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],a=e[4],o=e[5],l=e[6],c=e[7],h=e[8];return t*a*h-t*o*c-n*r*h+n*o*l+s*r*c-s*a*l}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],a=e[4],o=e[5],l=e[6],c=e[7],h=e[8],d=h*a-o*c,u=o*l-h*r,f=c*r-a*l,g=t*d+n*u+s*f;if(g===0)return this.set(0,0,0,0,0,0,0,0,0);let b=1/g;return e[0]=d*b,e[1]=(s*c-h*n)*b,e[2]=(o*n-s*a)*b,e[3]=u*b,e[4]=(h*t-s*l)*b,e[5]=(s*r-o*t)*b,e[6]=f*b,e[7]=(n*l-c*t)*b,e[8]=(a*t-n*r)*b,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,s,r,a,o){let l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*a+c*o)+a+e,-s*c,s*l,-s*(-c*a+l*o)+o+t,0,0,1),this}scale(e,t){return Hs("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(yl.makeScale(e,t)),this}rotate(e){return Hs("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(yl.makeRotation(-e)),this}translate(e,t){return Hs("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(yl.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<9;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},yl=new ke,Gh=new ke().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Vh=new ke().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function bp(){let i={enabled:!0,workingColorSpace:Ys,spaces:{},convert:function(s,r,a){return this.enabled===!1||r===a||!r||!a||(this.spaces[r].transfer===it&&(s.r=jn(s.r),s.g=jn(s.g),s.b=jn(s.b)),this.spaces[r].primaries!==this.spaces[a].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[a].fromXYZ)),this.spaces[a].transfer===it&&(s.r=us(s.r),s.g=us(s.g),s.b=us(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===wn?$s:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,a){return s.copy(this.spaces[a].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[Ys]:{primaries:e,whitePoint:n,transfer:$s,toXYZ:Gh,fromXYZ:Vh,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:kt},outputColorSpaceConfig:{drawingBufferColorSpace:kt}},[kt]:{primaries:e,whitePoint:n,transfer:it,toXYZ:Gh,fromXYZ:Vh,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:kt}}}),i}var Ze=bp();function jn(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function us(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var ji,Ra=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{ji===void 0&&(ji=Zs("canvas")),ji.width=e.width,ji.height=e.height;let s=ji.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),n=ji}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=Zs("canvas");t.width=e.width,t.height=e.height;let n=t.getContext("2d");n.drawImage(e,0,0,e.width,e.height);let s=n.getImageData(0,0,e.width,e.height),r=s.data;for(let a=0;a<r.length;a++)r[a]=jn(r[a]/255)*255;return n.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let n=0;n<t.length;n++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[n]=Math.floor(jn(t[n]/255)*255):t[n]=jn(t[n]);return{data:t,width:e.width,height:e.height}}else return De("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},Mp=0,ys=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Mp++}),this.uuid=Rs(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let a=0,o=s.length;a<o;a++)s[a].isDataTexture?r.push(_l(s[a].image)):r.push(_l(s[a]))}else r=_l(s);n.url=r}return t||(e.images[this.uuid]=n),n}};function _l(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?Ra.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(De("Texture: Unable to serialize Texture."),{})}var Sp=0,xl=new k,zt=class i extends rn{constructor(e=i.DEFAULT_IMAGE,t=i.DEFAULT_MAPPING,n=In,s=In,r=Et,a=ni,o=Sn,l=jt,c=i.DEFAULT_ANISOTROPY,h=wn){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Sp++}),this.uuid=Rs(),this.name="",this.source=new ys(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=a,this.anisotropy=c,this.format=o,this.internalFormat=null,this.type=l,this.offset=new Oe(0,0),this.repeat=new Oe(1,1),this.center=new Oe(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new ke,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(xl).x}get height(){return this.source.getSize(xl).y}get depth(){return this.source.getSize(xl).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){De(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){De(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==nc)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case fs:e.x=e.x-Math.floor(e.x);break;case In:e.x=e.x<0?0:1;break;case Aa:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case fs:e.y=e.y-Math.floor(e.y);break;case In:e.y=e.y<0?0:1;break;case Aa:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};zt.DEFAULT_IMAGE=null;zt.DEFAULT_MAPPING=nc;zt.DEFAULT_ANISOTROPY=1;var mt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,s=1){this.x=e,this.y=t,this.z=n,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,s){return this.x=e,this.y=t,this.z=n,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*s+a[12]*r,this.y=a[1]*t+a[5]*n+a[9]*s+a[13]*r,this.z=a[2]*t+a[6]*n+a[10]*s+a[14]*r,this.w=a[3]*t+a[7]*n+a[11]*s+a[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,s,r,l=e.elements,c=l[0],h=l[4],d=l[8],u=l[1],f=l[5],g=l[9],b=l[2],p=l[6],m=l[10];if(Math.abs(h-u)<.01&&Math.abs(d-b)<.01&&Math.abs(g-p)<.01){if(Math.abs(h+u)<.1&&Math.abs(d+b)<.1&&Math.abs(g+p)<.1&&Math.abs(c+f+m-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let C=(c+1)/2,E=(f+1)/2,P=(m+1)/2,R=(h+u)/4,_=(d+b)/4,w=(g+p)/4;return C>E&&C>P?C<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(C),s=R/n,r=_/n):E>P?E<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(E),n=R/s,r=w/s):P<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(P),n=_/r,s=w/r),this.set(n,s,r,t),this}let S=Math.sqrt((p-g)*(p-g)+(d-b)*(d-b)+(u-h)*(u-h));return Math.abs(S)<.001&&(S=1),this.x=(p-g)/S,this.y=(d-b)/S,this.z=(u-h)/S,this.w=Math.acos((c+f+m-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=Xe(this.x,e.x,t.x),this.y=Xe(this.y,e.y,t.y),this.z=Xe(this.z,e.z,t.z),this.w=Xe(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=Xe(this.x,e,t),this.y=Xe(this.y,e,t),this.z=Xe(this.z,e,t),this.w=Xe(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Xe(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Ca=class extends rn{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Et,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new mt(0,0,e,t),this.scissorTest=!1,this.viewport=new mt(0,0,e,t),this.textures=[];let s=n.count;for(let r=0;r<s;r++)this.textures[r]=new zt({width:e,height:t,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:Et,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new ys(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},on=class extends Ca{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},Ks=class extends zt{constructor(e=null,t=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=Lt,this.minFilter=Lt,this.wrapR=In,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var Pa=class extends zt{constructor(e=null,t=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=Lt,this.minFilter=Lt,this.wrapR=In,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var ht=class i{static{this.prototype.isMatrix4=!0}constructor(e,t,n,s,r,a,o,l,c,h,d,u,f,g,b,p){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,a,o,l,c,h,d,u,f,g,b,p)}set(e,t,n,s,r,a,o,l,c,h,d,u,f,g,b,p){let m=this.elements;return m[0]=e,m[4]=t,m[8]=n,m[12]=s,m[1]=r,m[5]=a,m[9]=o,m[13]=l,m[2]=c,m[6]=h,m[10]=d,m[14]=u,m[3]=f,m[7]=g,m[11]=b,m[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,s=1/Qi.setFromMatrixColumn(e,0).length(),r=1/Qi.setFromMatrixColumn(e,1).length(),a=1/Qi.setFromMatrixColumn(e,2).length();return t[0]=n[0]*s,t[1]=n[1]*s,t[2]=n[2]*s,t[3]=0,t[4]=n[4]*r,t[5]=n[5]*r,t[6]=n[6]*r,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,s=e.y,r=e.z,a=Math.cos(n),o=Math.sin(n),l=Math.cos(s),c=Math.sin(s),h=Math.cos(r),d=Math.sin(r);if(e.order==="XYZ"){let u=a*h,f=a*d,g=o*h,b=o*d;t[0]=l*h,t[4]=-l*d,t[8]=c,t[1]=f+g*c,t[5]=u-b*c,t[9]=-o*l,t[2]=b-u*c,t[6]=g+f*c,t[10]=a*l}else if(e.order==="YXZ"){let u=l*h,f=l*d,g=c*h,b=c*d;t[0]=u+b*o,t[4]=g*o-f,t[8]=a*c,t[1]=a*d,t[5]=a*h,t[9]=-o,t[2]=f*o-g,t[6]=b+u*o,t[10]=a*l}else if(e.order==="ZXY"){let u=l*h,f=l*d,g=c*h,b=c*d;t[0]=u-b*o,t[4]=-a*d,t[8]=g+f*o,t[1]=f+g*o,t[5]=a*h,t[9]=b-u*o,t[2]=-a*c,t[6]=o,t[10]=a*l}else if(e.order==="ZYX"){let u=a*h,f=a*d,g=o*h,b=o*d;t[0]=l*h,t[4]=g*c-f,t[8]=u*c+b,t[1]=l*d,t[5]=b*c+u,t[9]=f*c-g,t[2]=-c,t[6]=o*l,t[10]=a*l}else if(e.order==="YZX"){let u=a*l,f=a*c,g=o*l,b=o*c;t[0]=l*h,t[4]=b-u*d,t[8]=g*d+f,t[1]=d,t[5]=a*h,t[9]=-o*h,t[2]=-c*h,t[6]=f*d+g,t[10]=u-b*d}else if(e.order==="XZY"){let u=a*l,f=a*c,g=o*l,b=o*c;t[0]=l*h,t[4]=-d,t[8]=c*h,t[1]=u*d+b,t[5]=a*h,t[9]=f*d-g,t[2]=g*d-f,t[6]=o*h,t[10]=b*d+u}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(wp,e,Ep)}lookAt(e,t,n){let s=this.elements;return tn.subVectors(e,t),tn.lengthSq()===0&&(tn.z=1),tn.normalize(),li.crossVectors(n,tn),li.lengthSq()===0&&(Math.abs(n.z)===1?tn.x+=1e-4:tn.z+=1e-4,tn.normalize(),li.crossVectors(n,tn)),li.normalize(),Jr.crossVectors(tn,li),s[0]=li.x,s[4]=Jr.x,s[8]=tn.x,s[1]=li.y,s[5]=Jr.y,s[9]=tn.y,s[2]=li.z,s[6]=Jr.z,s[10]=tn.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,a=n[0],o=n[4],l=n[8],c=n[12],h=n[1],d=n[5],u=n[9],f=n[13],g=n[2],b=n[6],p=n[10],m=n[14],S=n[3],C=n[7],E=n[11],P=n[15],R=s[0],_=s[4],w=s[8],H=s[12],O=s[1],z=s[5],$=s[9],te=s[13],U=s[2],j=s[6],ie=s[10],Z=s[14],he=s[3],K=s[7],oe=s[11],le=s[15];return r[0]=a*R+o*O+l*U+c*he,r[4]=a*_+o*z+l*j+c*K,r[8]=a*w+o*$+l*ie+c*oe,r[12]=a*H+o*te+l*Z+c*le,r[1]=h*R+d*O+u*U+f*he,r[5]=h*_+d*z+u*j+f*K,r[9]=h*w+d*$+u*ie+f*oe,r[13]=h*H+d*te+u*Z+f*le,r[2]=g*R+b*O+p*U+m*he,r[6]=g*_+b*z+p*j+m*K,r[10]=g*w+b*$+p*ie+m*oe,r[14]=g*H+b*te+p*Z+m*le,r[3]=S*R+C*O+E*U+P*he,r[7]=S*_+C*z+E*j+P*K,r[11]=S*w+C*$+E*ie+P*oe,r[15]=S*H+C*te+E*Z+P*le,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[12],a=e[1],o=e[5],l=e[9],c=e[13],h=e[2],d=e[6],u=e[10],f=e[14],g=e[3],b=e[7],p=e[11],m=e[15],S=l*f-c*u,C=o*f-c*d,E=o*u-l*d,P=a*f-c*h,R=a*u-l*h,_=a*d-o*h;return t*(b*S-p*C+m*E)-n*(g*S-p*P+m*R)+s*(g*C-b*P+m*_)-r*(g*E-b*R+p*_)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[1],a=e[5],o=e[9],l=e[2],c=e[6],h=e[10];return t*(a*h-o*c)-n*(r*h-o*l)+s*(r*c-a*l)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],a=e[4],o=e[5],l=e[6],c=e[7],h=e[8],d=e[9],u=e[10],f=e[11],g=e[12],b=e[13],p=e[14],m=e[15],S=t*o-n*a,C=t*l-s*a,E=t*c-r*a,P=n*l-s*o,R=n*c-r*o,_=s*c-r*l,w=h*b-d*g,H=h*p-u*g,O=h*m-f*g,z=d*p-u*b,$=d*m-f*b,te=u*m-f*p,U=S*te-C*$+E*z+P*O-R*H+_*w;if(U===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let j=1/U;return e[0]=(o*te-l*$+c*z)*j,e[1]=(s*$-n*te-r*z)*j,e[2]=(b*_-p*R+m*P)*j,e[3]=(u*R-d*_-f*P)*j,e[4]=(l*O-a*te-c*H)*j,e[5]=(t*te-s*O+r*H)*j,e[6]=(p*E-g*_-m*C)*j,e[7]=(h*_-u*E+f*C)*j,e[8]=(a*$-o*O+c*w)*j,e[9]=(n*O-t*$-r*w)*j,e[10]=(g*R-b*E+m*S)*j,e[11]=(d*E-h*R-f*S)*j,e[12]=(o*H-a*z-l*w)*j,e[13]=(t*z-n*H+s*w)*j,e[14]=(b*C-g*P-p*S)*j,e[15]=(h*P-d*C+u*S)*j,this}scale(e){let t=this.elements,n=e.x,s=e.y,r=e.z;return t[0]*=n,t[4]*=s,t[8]*=r,t[1]*=n,t[5]*=s,t[9]*=r,t[2]*=n,t[6]*=s,t[10]*=r,t[3]*=n,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,s))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),s=Math.sin(t),r=1-n,a=e.x,o=e.y,l=e.z,c=r*a,h=r*o;return this.set(c*a+n,c*o-s*l,c*l+s*o,0,c*o+s*l,h*o+n,h*l-s*a,0,c*l-s*o,h*l+s*a,r*l*l+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,s,r,a){return this.set(1,n,r,0,e,1,a,0,t,s,1,0,0,0,0,1),this}compose(e,t,n){let s=this.elements,r=t._x,a=t._y,o=t._z,l=t._w,c=r+r,h=a+a,d=o+o,u=r*c,f=r*h,g=r*d,b=a*h,p=a*d,m=o*d,S=l*c,C=l*h,E=l*d,P=n.x,R=n.y,_=n.z;return s[0]=(1-(b+m))*P,s[1]=(f+E)*P,s[2]=(g-C)*P,s[3]=0,s[4]=(f-E)*R,s[5]=(1-(u+m))*R,s[6]=(p+S)*R,s[7]=0,s[8]=(g+C)*_,s[9]=(p-S)*_,s[10]=(1-(u+b))*_,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,n){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return n.set(1,1,1),t.identity(),this;let a=Qi.set(s[0],s[1],s[2]).length(),o=Qi.set(s[4],s[5],s[6]).length(),l=Qi.set(s[8],s[9],s[10]).length();r<0&&(a=-a),_n.copy(this);let c=1/a,h=1/o,d=1/l;return _n.elements[0]*=c,_n.elements[1]*=c,_n.elements[2]*=c,_n.elements[4]*=h,_n.elements[5]*=h,_n.elements[6]*=h,_n.elements[8]*=d,_n.elements[9]*=d,_n.elements[10]*=d,t.setFromRotationMatrix(_n),n.x=a,n.y=o,n.z=l,this}makePerspective(e,t,n,s,r,a,o=fn,l=!1){let c=this.elements,h=2*r/(t-e),d=2*r/(n-s),u=(t+e)/(t-e),f=(n+s)/(n-s),g,b;if(l)g=r/(a-r),b=a*r/(a-r);else if(o===fn)g=-(a+r)/(a-r),b=-2*a*r/(a-r);else if(o===ps)g=-a/(a-r),b=-a*r/(a-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+o);return c[0]=h,c[4]=0,c[8]=u,c[12]=0,c[1]=0,c[5]=d,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=g,c[14]=b,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,s,r,a,o=fn,l=!1){let c=this.elements,h=2/(t-e),d=2/(n-s),u=-(t+e)/(t-e),f=-(n+s)/(n-s),g,b;if(l)g=1/(a-r),b=a/(a-r);else if(o===fn)g=-2/(a-r),b=-(a+r)/(a-r);else if(o===ps)g=-1/(a-r),b=-r/(a-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+o);return c[0]=h,c[4]=0,c[8]=0,c[12]=u,c[1]=0,c[5]=d,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=g,c[14]=b,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<16;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Qi=new k,_n=new ht,wp=new k(0,0,0),Ep=new k(1,1,1),li=new k,Jr=new k,tn=new k,Hh=new ht,Wh=new an,ei=class i{constructor(e=0,t=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=n,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,s=this._order){return this._x=e,this._y=t,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let s=e.elements,r=s[0],a=s[4],o=s[8],l=s[1],c=s[5],h=s[9],d=s[2],u=s[6],f=s[10];switch(t){case"XYZ":this._y=Math.asin(Xe(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-h,f),this._z=Math.atan2(-a,r)):(this._x=Math.atan2(u,c),this._z=0);break;case"YXZ":this._x=Math.asin(-Xe(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-d,r),this._z=0);break;case"ZXY":this._x=Math.asin(Xe(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(-d,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-Xe(d,-1,1)),Math.abs(d)<.9999999?(this._x=Math.atan2(u,f),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-a,c));break;case"YZX":this._z=Math.asin(Xe(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-h,c),this._y=Math.atan2(-d,r)):(this._x=0,this._y=Math.atan2(o,f));break;case"XZY":this._z=Math.asin(-Xe(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(u,c),this._y=Math.atan2(o,r)):(this._x=Math.atan2(-h,f),this._y=0);break;default:De("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return Hh.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Hh,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Wh.setFromEuler(this),this.setFromQuaternion(Wh,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};ei.DEFAULT_ORDER="XYZ";var Js=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},Ap=0,Xh=new k,es=new an,qn=new ht,jr=new k,ks=new k,Tp=new k,Rp=new an,qh=new k(1,0,0),Yh=new k(0,1,0),$h=new k(0,0,1),Zh={type:"added"},Cp={type:"removed"},ts={type:"childadded",child:null},vl={type:"childremoved",child:null},Xt=class i extends rn{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Ap++}),this.uuid=Rs(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let e=new k,t=new ei,n=new an,s=new k(1,1,1);function r(){n.setFromEuler(t,!1)}function a(){t.setFromQuaternion(n,void 0,!1)}t._onChange(r),n._onChange(a),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new ht},normalMatrix:{value:new ke}}),this.matrix=new ht,this.matrixWorld=new ht,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Js,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return es.setFromAxisAngle(e,t),this.quaternion.multiply(es),this}rotateOnWorldAxis(e,t){return es.setFromAxisAngle(e,t),this.quaternion.premultiply(es),this}rotateX(e){return this.rotateOnAxis(qh,e)}rotateY(e){return this.rotateOnAxis(Yh,e)}rotateZ(e){return this.rotateOnAxis($h,e)}translateOnAxis(e,t){return Xh.copy(e).applyQuaternion(this.quaternion),this.position.add(Xh.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(qh,e)}translateY(e){return this.translateOnAxis(Yh,e)}translateZ(e){return this.translateOnAxis($h,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(qn.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?jr.copy(e):jr.set(e,t,n);let s=this.parent;this.updateWorldMatrix(!0,!1),ks.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?qn.lookAt(ks,jr,this.up):qn.lookAt(jr,ks,this.up),this.quaternion.setFromRotationMatrix(qn),s&&(qn.extractRotation(s.matrixWorld),es.setFromRotationMatrix(qn),this.quaternion.premultiply(es.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(Fe("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(Zh),ts.child=e,this.dispatchEvent(ts),ts.child=null):Fe("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(Cp),vl.child=e,this.dispatchEvent(vl),vl.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),qn.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),qn.multiply(e.parent.matrixWorld)),e.applyMatrix4(qn),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(Zh),ts.child=e,this.dispatchEvent(ts),ts.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,s=this.children.length;n<s;n++){let a=this.children[n].getObjectByProperty(e,t);if(a!==void 0)return a}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let s=this.children;for(let r=0,a=s.length;r<a;r++)s[r].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(ks,e,Tp),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(ks,Rp,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*n-r[8]*s,r[13]+=n-r[1]*t-r[5]*n-r[9]*s,r[14]+=s-r[2]*t-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let r=this.children;for(let a=0,o=r.length;a<o;a++)r[a].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e=="string",n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(o=>({...o,boundingBox:o.boundingBox?o.boundingBox.toJSON():void 0,boundingSphere:o.boundingSphere?o.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(o=>({...o})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(o,l){return o[l.uuid]===void 0&&(o[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let o=this.geometry.parameters;if(o!==void 0&&o.shapes!==void 0){let l=o.shapes;if(Array.isArray(l))for(let c=0,h=l.length;c<h;c++){let d=l[c];r(e.shapes,d)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let o=[];for(let l=0,c=this.material.length;l<c;l++)o.push(r(e.materials,this.material[l]));s.material=o}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let o=0;o<this.children.length;o++)s.children.push(this.children[o].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let o=0;o<this.animations.length;o++){let l=this.animations[o];s.animations.push(r(e.animations,l))}}if(t){let o=a(e.geometries),l=a(e.materials),c=a(e.textures),h=a(e.images),d=a(e.shapes),u=a(e.skeletons),f=a(e.animations),g=a(e.nodes);o.length>0&&(n.geometries=o),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),h.length>0&&(n.images=h),d.length>0&&(n.shapes=d),u.length>0&&(n.skeletons=u),f.length>0&&(n.animations=f),g.length>0&&(n.nodes=g)}return n.object=s,n;function a(o){let l=[];for(let c in o){let h=o[c];delete h.metadata,l.push(h)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let n=0;n<e.children.length;n++){let s=e.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};Xt.DEFAULT_UP=new k(0,1,0);Xt.DEFAULT_MATRIX_AUTO_UPDATE=!0;Xt.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var Ln=class extends Xt{constructor(){super(),this.isGroup=!0,this.type="Group"}},Pp={type:"move"},_s=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Ln,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Ln,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new k,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new k),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Ln,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new k,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new k,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let s=null,r=null,a=null,o=this._targetRay,l=this._grip,c=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){a=!0;for(let b of e.hand.values()){let p=t.getJointPose(b,n),m=this._getHandJoint(c,b);p!==null&&(m.matrix.fromArray(p.transform.matrix),m.matrix.decompose(m.position,m.quaternion,m.scale),m.matrixWorldNeedsUpdate=!0,m.jointRadius=p.radius),m.visible=p!==null}let h=c.joints["index-finger-tip"],d=c.joints["thumb-tip"],u=h.position.distanceTo(d.position),f=.02,g=.005;c.inputState.pinching&&u>f+g?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&u<=f-g&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:e,target:this})));o!==null&&(s=t.getPose(e.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(o.matrix.fromArray(s.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,s.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(s.linearVelocity)):o.hasLinearVelocity=!1,s.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(s.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(Pp)))}return o!==null&&(o.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new Ln;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},Yu={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},ci={h:0,s:0,l:0},Qr={h:0,s:0,l:0};function bl(i,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?i+(e-i)*6*t:t<1/2?e:t<2/3?i+(e-i)*6*(2/3-t):i}var Ve=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=kt){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,Ze.colorSpaceToWorking(this,t),this}setRGB(e,t,n,s=Ze.workingColorSpace){return this.r=e,this.g=t,this.b=n,Ze.colorSpaceToWorking(this,s),this}setHSL(e,t,n,s=Ze.workingColorSpace){if(e=mc(e,1),t=Xe(t,0,1),n=Xe(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,a=2*n-r;this.r=bl(a,r,e+1/3),this.g=bl(a,r,e),this.b=bl(a,r,e-1/3)}return Ze.colorSpaceToWorking(this,s),this}setStyle(e,t=kt){function n(r){r!==void 0&&parseFloat(r)<1&&De("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,a=s[1],o=s[2];switch(a){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:De("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],a=r.length;if(a===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(a===6)return this.setHex(parseInt(r,16),t);De("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=kt){let n=Yu[e.toLowerCase()];return n!==void 0?this.setHex(n,t):De("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=jn(e.r),this.g=jn(e.g),this.b=jn(e.b),this}copyLinearToSRGB(e){return this.r=us(e.r),this.g=us(e.g),this.b=us(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=kt){return Ze.workingToColorSpace(Bt.copy(this),e),Math.round(Xe(Bt.r*255,0,255))*65536+Math.round(Xe(Bt.g*255,0,255))*256+Math.round(Xe(Bt.b*255,0,255))}getHexString(e=kt){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=Ze.workingColorSpace){Ze.workingToColorSpace(Bt.copy(this),t);let n=Bt.r,s=Bt.g,r=Bt.b,a=Math.max(n,s,r),o=Math.min(n,s,r),l,c,h=(o+a)/2;if(o===a)l=0,c=0;else{let d=a-o;switch(c=h<=.5?d/(a+o):d/(2-a-o),a){case n:l=(s-r)/d+(s<r?6:0);break;case s:l=(r-n)/d+2;break;case r:l=(n-s)/d+4;break}l/=6}return e.h=l,e.s=c,e.l=h,e}getRGB(e,t=Ze.workingColorSpace){return Ze.workingToColorSpace(Bt.copy(this),t),e.r=Bt.r,e.g=Bt.g,e.b=Bt.b,e}getStyle(e=kt){Ze.workingToColorSpace(Bt.copy(this),e);let t=Bt.r,n=Bt.g,s=Bt.b;return e!==kt?`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(e,t,n){return this.getHSL(ci),this.setHSL(ci.h+e,ci.s+t,ci.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(ci),e.getHSL(Qr);let n=Xs(ci.h,Qr.h,t),s=Xs(ci.s,Qr.s,t),r=Xs(ci.l,Qr.l,t);return this.setHSL(n,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*n+r[6]*s,this.g=r[1]*t+r[4]*n+r[7]*s,this.b=r[2]*t+r[5]*n+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Bt=new Ve;Ve.NAMES=Yu;var js=class extends Xt{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new ei,this.environmentIntensity=1,this.environmentRotation=new ei,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},xn=new k,Yn=new k,Ml=new k,$n=new k,ns=new k,is=new k,Kh=new k,Sl=new k,wl=new k,El=new k,Al=new mt,Tl=new mt,Rl=new mt,Pn=class i{constructor(e=new k,t=new k,n=new k){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,s){s.subVectors(n,t),xn.subVectors(e,t),s.cross(xn);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,n,s,r){xn.subVectors(s,t),Yn.subVectors(n,t),Ml.subVectors(e,t);let a=xn.dot(xn),o=xn.dot(Yn),l=xn.dot(Ml),c=Yn.dot(Yn),h=Yn.dot(Ml),d=a*c-o*o;if(d===0)return r.set(0,0,0),null;let u=1/d,f=(c*l-o*h)*u,g=(a*h-o*l)*u;return r.set(1-f-g,g,f)}static containsPoint(e,t,n,s){return this.getBarycoord(e,t,n,s,$n)===null?!1:$n.x>=0&&$n.y>=0&&$n.x+$n.y<=1}static getInterpolation(e,t,n,s,r,a,o,l){return this.getBarycoord(e,t,n,s,$n)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,$n.x),l.addScaledVector(a,$n.y),l.addScaledVector(o,$n.z),l)}static getInterpolatedAttribute(e,t,n,s,r,a){return Al.setScalar(0),Tl.setScalar(0),Rl.setScalar(0),Al.fromBufferAttribute(e,t),Tl.fromBufferAttribute(e,n),Rl.fromBufferAttribute(e,s),a.setScalar(0),a.addScaledVector(Al,r.x),a.addScaledVector(Tl,r.y),a.addScaledVector(Rl,r.z),a}static isFrontFacing(e,t,n,s){return xn.subVectors(n,t),Yn.subVectors(e,t),xn.cross(Yn).dot(s)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,s){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,n,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return xn.subVectors(this.c,this.b),Yn.subVectors(this.a,this.b),xn.cross(Yn).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return i.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return i.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,n,s,r){return i.getInterpolation(e,this.a,this.b,this.c,t,n,s,r)}containsPoint(e){return i.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return i.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,s=this.b,r=this.c,a,o;ns.subVectors(s,n),is.subVectors(r,n),Sl.subVectors(e,n);let l=ns.dot(Sl),c=is.dot(Sl);if(l<=0&&c<=0)return t.copy(n);wl.subVectors(e,s);let h=ns.dot(wl),d=is.dot(wl);if(h>=0&&d<=h)return t.copy(s);let u=l*d-h*c;if(u<=0&&l>=0&&h<=0&&l-h>0)return a=l/(l-h),t.copy(n).addScaledVector(ns,a);El.subVectors(e,r);let f=ns.dot(El),g=is.dot(El);if(g>=0&&f<=g)return t.copy(r);let b=f*c-l*g;if(b<=0&&c>=0&&g<=0)return o=c/(c-g),t.copy(n).addScaledVector(is,o);let p=h*g-f*d;if(p<=0&&d-h>=0&&f-g>=0)return Kh.subVectors(r,s),o=(d-h)/(d-h+(f-g)),t.copy(s).addScaledVector(Kh,o);let m=1/(p+b+u);return a=b*m,o=u*m,t.copy(n).addScaledVector(ns,a).addScaledVector(is,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},ln=class{constructor(e=new k(1/0,1/0,1/0),t=new k(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(vn.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(vn.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=vn.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let a=0,o=r.count;a<o;a++)e.isMesh===!0?e.getVertexPosition(a,vn):vn.fromBufferAttribute(r,a),vn.applyMatrix4(e.matrixWorld),this.expandByPoint(vn);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),ea.copy(e.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),ea.copy(n.boundingBox)),ea.applyMatrix4(e.matrixWorld),this.union(ea)}let s=e.children;for(let r=0,a=s.length;r<a;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,vn),vn.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(zs),ta.subVectors(this.max,zs),ss.subVectors(e.a,zs),rs.subVectors(e.b,zs),as.subVectors(e.c,zs),hi.subVectors(rs,ss),ui.subVectors(as,rs),Li.subVectors(ss,as);let t=[0,-hi.z,hi.y,0,-ui.z,ui.y,0,-Li.z,Li.y,hi.z,0,-hi.x,ui.z,0,-ui.x,Li.z,0,-Li.x,-hi.y,hi.x,0,-ui.y,ui.x,0,-Li.y,Li.x,0];return!Cl(t,ss,rs,as,ta)||(t=[1,0,0,0,1,0,0,0,1],!Cl(t,ss,rs,as,ta))?!1:(na.crossVectors(hi,ui),t=[na.x,na.y,na.z],Cl(t,ss,rs,as,ta))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,vn).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(vn).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(Zn[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Zn[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Zn[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Zn[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Zn[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Zn[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Zn[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Zn[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Zn),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Zn=[new k,new k,new k,new k,new k,new k,new k,new k],vn=new k,ea=new ln,ss=new k,rs=new k,as=new k,hi=new k,ui=new k,Li=new k,zs=new k,ta=new k,na=new k,Di=new k;function Cl(i,e,t,n,s){for(let r=0,a=i.length-3;r<=a;r+=3){Di.fromArray(i,r);let o=s.x*Math.abs(Di.x)+s.y*Math.abs(Di.y)+s.z*Math.abs(Di.z),l=e.dot(Di),c=t.dot(Di),h=n.dot(Di);if(Math.max(-Math.max(l,c,h),Math.min(l,c,h))>o)return!1}return!0}var Jn=Ip();function Ip(){let i=new ArrayBuffer(4),e=new Float32Array(i),t=new Uint32Array(i),n=new Uint32Array(512),s=new Uint32Array(512);for(let l=0;l<256;++l){let c=l-127;c<-27?(n[l]=0,n[l|256]=32768,s[l]=24,s[l|256]=24):c<-14?(n[l]=1024>>-c-14,n[l|256]=1024>>-c-14|32768,s[l]=-c-1,s[l|256]=-c-1):c<=15?(n[l]=c+15<<10,n[l|256]=c+15<<10|32768,s[l]=13,s[l|256]=13):c<128?(n[l]=31744,n[l|256]=64512,s[l]=24,s[l|256]=24):(n[l]=31744,n[l|256]=64512,s[l]=13,s[l|256]=13)}let r=new Uint32Array(2048),a=new Uint32Array(64),o=new Uint32Array(64);for(let l=1;l<1024;++l){let c=l<<13,h=0;for(;(c&8388608)===0;)c<<=1,h-=8388608;c&=-8388609,h+=947912704,r[l]=c|h}for(let l=1024;l<2048;++l)r[l]=939524096+(l-1024<<13);for(let l=1;l<31;++l)a[l]=l<<23;a[31]=1199570944,a[32]=2147483648;for(let l=33;l<63;++l)a[l]=2147483648+(l-32<<23);a[63]=3347054592;for(let l=1;l<64;++l)l!==32&&(o[l]=1024);return{floatView:e,uint32View:t,baseTable:n,shiftTable:s,mantissaTable:r,exponentTable:a,offsetTable:o}}function Lp(i){Math.abs(i)>65504&&De("DataUtils.toHalfFloat(): Value out of range."),i=Xe(i,-65504,65504),Jn.floatView[0]=i;let e=Jn.uint32View[0],t=e>>23&511;return Jn.baseTable[t]+((e&8388607)>>Jn.shiftTable[t])}function Dp(i){let e=i>>10;return Jn.uint32View[0]=Jn.mantissaTable[Jn.offsetTable[e]+(i&1023)]+Jn.exponentTable[e],Jn.floatView[0]}var Qs=class{static toHalfFloat(e){return Lp(e)}static fromHalfFloat(e){return Dp(e)}},wt=new k,ia=new Oe,Np=0,vt=class extends rn{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Np++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=n,this.usage=zu,this.updateRanges=[],this.gpuType=Mn,this.version=0,this._normalizationScale=e!==void 0?yc(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[n+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)ia.fromBufferAttribute(this,t),ia.applyMatrix3(e),this.setXY(t,ia.x,ia.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)wt.fromBufferAttribute(this,t),wt.applyMatrix3(e),this.setXYZ(t,wt.x,wt.y,wt.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)wt.fromBufferAttribute(this,t),wt.applyMatrix4(e),this.setXYZ(t,wt.x,wt.y,wt.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)wt.fromBufferAttribute(this,t),wt.applyNormalMatrix(e),this.setXYZ(t,wt.x,wt.y,wt.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)wt.fromBufferAttribute(this,t),wt.transformDirection(e),this.setXYZ(t,wt.x,wt.y,wt.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this}setXYZW(e,t,n,s,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):Xu(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):qu(e,this.array)}};var er=class extends vt{constructor(e,t,n){super(new Uint16Array(e),t,n)}};var tr=class extends vt{constructor(e,t,n){super(new Uint32Array(e),t,n)}};var pn=class extends vt{constructor(e,t,n){super(new Float32Array(e),t,n)}},Up=new ln,Gs=new k,Pl=new k,fi=class{constructor(e=new k,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t!==void 0?n.copy(t):Up.setFromPoints(e).getCenter(n);let s=0;for(let r=0,a=e.length;r<a;r++)s=Math.max(s,n.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;Gs.subVectors(e,this.center);let t=Gs.lengthSq();if(t>this.radius*this.radius){let n=Math.sqrt(t),s=(n-this.radius)*.5;this.center.addScaledVector(Gs,s/n),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Pl.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(Gs.copy(e.center).add(Pl)),this.expandByPoint(Gs.copy(e.center).sub(Pl))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},Fp=0,dn=new ht,Il=new Xt,os=new k,nn=new ln,Vs=new ln,It=new k,Dn=class i extends rn{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Fp++}),this.uuid=Rs(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(sp(e)?tr:er)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new ke().getNormalMatrix(e);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return dn.makeRotationFromQuaternion(e),this.applyMatrix4(dn),this}rotateX(e){return dn.makeRotationX(e),this.applyMatrix4(dn),this}rotateY(e){return dn.makeRotationY(e),this.applyMatrix4(dn),this}rotateZ(e){return dn.makeRotationZ(e),this.applyMatrix4(dn),this}translate(e,t,n){return dn.makeTranslation(e,t,n),this.applyMatrix4(dn),this}scale(e,t,n){return dn.makeScale(e,t,n),this.applyMatrix4(dn),this}lookAt(e){return Il.lookAt(e),Il.updateMatrix(),this.applyMatrix4(Il.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(os).negate(),this.translate(os.x,os.y,os.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let n=[];for(let s=0,r=e.length;s<r;s++){let a=e[s];n.push(a.x,a.y,a.z||0)}this.setAttribute("position",new pn(n,3))}else{let n=Math.min(e.length,t.count);for(let s=0;s<n;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&De("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new ln);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Fe("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new k(-1/0,-1/0,-1/0),new k(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let n=0,s=t.length;n<s;n++){let r=t[n];nn.setFromBufferAttribute(r),this.morphTargetsRelative?(It.addVectors(this.boundingBox.min,nn.min),this.boundingBox.expandByPoint(It),It.addVectors(this.boundingBox.max,nn.max),this.boundingBox.expandByPoint(It)):(this.boundingBox.expandByPoint(nn.min),this.boundingBox.expandByPoint(nn.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Fe('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new fi);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Fe("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new k,1/0);return}if(e){let n=this.boundingSphere.center;if(nn.setFromBufferAttribute(e),t)for(let r=0,a=t.length;r<a;r++){let o=t[r];Vs.setFromBufferAttribute(o),this.morphTargetsRelative?(It.addVectors(nn.min,Vs.min),nn.expandByPoint(It),It.addVectors(nn.max,Vs.max),nn.expandByPoint(It)):(nn.expandByPoint(Vs.min),nn.expandByPoint(Vs.max))}nn.getCenter(n);let s=0;for(let r=0,a=e.count;r<a;r++)It.fromBufferAttribute(e,r),s=Math.max(s,n.distanceToSquared(It));if(t)for(let r=0,a=t.length;r<a;r++){let o=t[r],l=this.morphTargetsRelative;for(let c=0,h=o.count;c<h;c++)It.fromBufferAttribute(o,c),l&&(os.fromBufferAttribute(e,c),It.add(os)),s=Math.max(s,n.distanceToSquared(It))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Fe('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Fe("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=t.position,s=t.normal,r=t.uv,a=this.getAttribute("tangent");(a===void 0||a.count!==n.count)&&(a=new vt(new Float32Array(4*n.count),4),this.setAttribute("tangent",a));let o=[],l=[],c=new Uint8Array(n.count);for(let H=0;H<n.count;H++)o[H]=new k,l[H]=new k;let h=new k,d=new k,u=new k,f=new Oe,g=new Oe,b=new Oe,p=new k,m=new k;function S(H,O,z){c[H]=c[O]=c[z]=1,h.fromBufferAttribute(n,H),d.fromBufferAttribute(n,O),u.fromBufferAttribute(n,z),f.fromBufferAttribute(r,H),g.fromBufferAttribute(r,O),b.fromBufferAttribute(r,z),d.sub(h),u.sub(h),g.sub(f),b.sub(f);let $=1/(g.x*b.y-b.x*g.y);isFinite($)&&(p.copy(d).multiplyScalar(b.y).addScaledVector(u,-g.y).multiplyScalar($),m.copy(u).multiplyScalar(g.x).addScaledVector(d,-b.x).multiplyScalar($),o[H].add(p),o[O].add(p),o[z].add(p),l[H].add(m),l[O].add(m),l[z].add(m))}let C=this.groups;C.length===0&&(C=[{start:0,count:e.count}]);for(let H=0,O=C.length;H<O;++H){let z=C[H],$=z.start,te=z.count;for(let U=$,j=$+te;U<j;U+=3)S(e.getX(U+0),e.getX(U+1),e.getX(U+2))}let E=new k,P=new k,R=new k,_=new k;function w(H){R.fromBufferAttribute(s,H),_.copy(R);let O=o[H];E.copy(O),E.sub(R.multiplyScalar(R.dot(O))).normalize(),P.crossVectors(_,O);let $=P.dot(l[H])<0?-1:1;a.setXYZW(H,E.x,E.y,E.z,$)}for(let H=0,O=n.count;H<O;++H)c[H]&&w(H);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==t.count)n=new vt(new Float32Array(t.count*3),3),this.setAttribute("normal",n);else for(let u=0,f=n.count;u<f;u++)n.setXYZ(u,0,0,0);let s=new k,r=new k,a=new k,o=new k,l=new k,c=new k,h=new k,d=new k;if(e)for(let u=0,f=e.count;u<f;u+=3){let g=e.getX(u+0),b=e.getX(u+1),p=e.getX(u+2);s.fromBufferAttribute(t,g),r.fromBufferAttribute(t,b),a.fromBufferAttribute(t,p),h.subVectors(a,r),d.subVectors(s,r),h.cross(d),o.fromBufferAttribute(n,g),l.fromBufferAttribute(n,b),c.fromBufferAttribute(n,p),o.add(h),l.add(h),c.add(h),n.setXYZ(g,o.x,o.y,o.z),n.setXYZ(b,l.x,l.y,l.z),n.setXYZ(p,c.x,c.y,c.z)}else for(let u=0,f=t.count;u<f;u+=3)s.fromBufferAttribute(t,u+0),r.fromBufferAttribute(t,u+1),a.fromBufferAttribute(t,u+2),h.subVectors(a,r),d.subVectors(s,r),h.cross(d),n.setXYZ(u+0,h.x,h.y,h.z),n.setXYZ(u+1,h.x,h.y,h.z),n.setXYZ(u+2,h.x,h.y,h.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)It.fromBufferAttribute(e,t),It.normalize(),e.setXYZ(t,It.x,It.y,It.z)}toNonIndexed(){function e(o,l){let c=o.array,h=o.itemSize,d=o.normalized,u=new c.constructor(l.length*h),f=0,g=0;for(let b=0,p=l.length;b<p;b++){o.isInterleavedBufferAttribute?f=l[b]*o.data.stride+o.offset:f=l[b]*h;for(let m=0;m<h;m++)u[g++]=c[f++]}return new vt(u,h,d)}if(this.index===null)return De("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new i,n=this.index.array,s=this.attributes;for(let o in s){let l=s[o],c=e(l,n);t.setAttribute(o,c)}let r=this.morphAttributes;for(let o in r){let l=[],c=r[o];for(let h=0,d=c.length;h<d;h++){let u=c[h],f=e(u,n);l.push(f)}t.morphAttributes[o]=l}t.morphTargetsRelative=this.morphTargetsRelative;let a=this.groups;for(let o=0,l=a.length;o<l;o++){let c=a[o];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let l in n){let c=n[l];e.data.attributes[l]=c.toJSON(e.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],h=[];for(let d=0,u=c.length;d<u;d++){let f=c[d];h.push(f.toJSON(e.data))}h.length>0&&(s[l]=h,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let s=e.attributes;for(let c in s){let h=s[c];this.setAttribute(c,h.clone(t))}let r=e.morphAttributes;for(let c in r){let h=[],d=r[c];for(let u=0,f=d.length;u<f;u++)h.push(d[u].clone(t));this.morphAttributes[c]=h}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let c=0,h=a.length;c<h;c++){let d=a[c];this.addGroup(d.start,d.count,d.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var Ll=new k,Op=new k,Bp=new ke,sn=class{constructor(e=new k(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,s){return this.normal.set(e,t,n),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let s=Ll.subVectors(n,t).cross(Op.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let s=e.delta(Ll),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/r;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(s,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||Bp.getNormalMatrix(e),s=this.coplanarPoint(Ll).applyMatrix4(e),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},kp=0,pi=class extends rn{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:kp++}),this.uuid=Rs(),this.name="",this.type="Material",this.blending=ws,this.side=Fn,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=Yl,this.blendDst=$l,this.blendEquation=Gi,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Ve(0,0,0),this.blendAlpha=0,this.depthFunc=ds,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=Nu,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=_a,this.stencilZFail=_a,this.stencilZPass=_a,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){De(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){De(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let a=[];for(let o in r){let l=r[o];delete l.metadata,a.push(l)}return a}if(t){let r=s(e.textures),a=s(e.images);r.length>0&&(n.textures=r),a.length>0&&(n.images=a)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new Ve().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(n=>new sn().fromJSON(n))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let n=e.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new Oe().fromArray(n)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Oe().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let s=t.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var Kn=new k,Dl=new k,sa=new k,ra=new k,xs=class{constructor(e=new k,t=new k(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,Kn)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=Kn.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(Kn.copy(this.origin).addScaledVector(this.direction,t),Kn.distanceToSquared(e))}distanceSqToSegment(e,t,n,s){Dl.copy(e).add(t).multiplyScalar(.5),sa.copy(t).sub(e).normalize(),ra.copy(this.origin).sub(Dl);let r=e.distanceTo(t)*.5,a=-this.direction.dot(sa),o=ra.dot(this.direction),l=-ra.dot(sa),c=ra.lengthSq(),h=Math.abs(1-a*a),d,u,f,g;if(h>0)if(d=a*l-o,u=a*o-l,g=r*h,d>=0)if(u>=-g)if(u<=g){let b=1/h;d*=b,u*=b,f=d*(d+a*u+2*o)+u*(a*d+u+2*l)+c}else u=r,d=Math.max(0,-(a*u+o)),f=-d*d+u*(u+2*l)+c;else u=-r,d=Math.max(0,-(a*u+o)),f=-d*d+u*(u+2*l)+c;else u<=-g?(d=Math.max(0,-(-a*r+o)),u=d>0?-r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c):u<=g?(d=0,u=Math.min(Math.max(-r,-l),r),f=u*(u+2*l)+c):(d=Math.max(0,-(a*r+o)),u=d>0?r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c);else u=a>0?-r:r,d=Math.max(0,-(a*u+o)),f=-d*d+u*(u+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,d),s&&s.copy(Dl).addScaledVector(sa,u),f}intersectSphere(e,t){if(e.radius<0)return null;Kn.subVectors(e.center,this.origin);let n=Kn.dot(this.direction),s=Kn.dot(Kn)-n*n,r=e.radius*e.radius;if(s>r)return null;let a=Math.sqrt(r-s),o=n-a,l=n+a;return l<0?null:o<0?this.at(l,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,s,r,a,o,l,c=1/this.direction.x,h=1/this.direction.y,d=1/this.direction.z,u=this.origin;return c>=0?(n=(e.min.x-u.x)*c,s=(e.max.x-u.x)*c):(n=(e.max.x-u.x)*c,s=(e.min.x-u.x)*c),h>=0?(r=(e.min.y-u.y)*h,a=(e.max.y-u.y)*h):(r=(e.max.y-u.y)*h,a=(e.min.y-u.y)*h),n>a||r>s||((r>n||isNaN(n))&&(n=r),(a<s||isNaN(s))&&(s=a),d>=0?(o=(e.min.z-u.z)*d,l=(e.max.z-u.z)*d):(o=(e.max.z-u.z)*d,l=(e.min.z-u.z)*d),n>l||o>s)||((o>n||n!==n)&&(n=o),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,t)}intersectsBox(e){return this.intersectBox(e,Kn)!==null}intersectTriangle(e,t,n,s,r){let a=this.origin,o=this.direction,l=o.x,c=o.y,h=o.z,d=e.x-a.x,u=e.y-a.y,f=e.z-a.z,g=t.x-a.x,b=t.y-a.y,p=t.z-a.z,m=n.x-a.x,S=n.y-a.y,C=n.z-a.z,E=Math.abs(l),P=Math.abs(c),R=Math.abs(h),_,w,H,O,z,$,te,U,j,ie,Z,he;if(E>=P&&E>=R?(H=l,$=d,j=g,he=m,l>=0?(_=c,w=h,O=u,z=f,te=b,U=p,ie=S,Z=C):(_=h,w=c,O=f,z=u,te=p,U=b,ie=C,Z=S)):P>=R?(H=c,$=u,j=b,he=S,c>=0?(_=h,w=l,O=f,z=d,te=p,U=g,ie=C,Z=m):(_=l,w=h,O=d,z=f,te=g,U=p,ie=m,Z=C)):(H=h,$=f,j=p,he=C,h>=0?(_=l,w=c,O=d,z=u,te=g,U=b,ie=m,Z=S):(_=c,w=l,O=u,z=d,te=b,U=g,ie=S,Z=m)),H===0)return null;let K=_/H,oe=w/H,le=1/H,Re=O-K*$,Ne=z-oe*$,se=te-K*j,ye=U-oe*j,Se=ie-K*he,Le=Z-oe*he,_e=Se*ye-Le*se,Be=Re*Le-Ne*Se,ot=se*Ne-ye*Re;if(s){if(_e<0||Be<0||ot<0)return null}else if((_e<0||Be<0||ot<0)&&(_e>0||Be>0||ot>0))return null;let Pe=_e+Be+ot;if(Pe===0)return null;let Ke=le*(_e*$+Be*j+ot*he);return(Pe>0?Ke<0:Ke>0)?null:this.at(Ke/Pe,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Fi=class extends pi{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new Ve(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ei,this.combine=Zl,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},Jh=new ht,Ni=new xs,aa=new fi,jh=new k,oa=new k,la=new k,ca=new k,Nl=new k,ha=new k,Qh=new k,ua=new k,Gt=class extends Xt{constructor(e=new Dn,t=new Fi){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,a=s.length;r<a;r++){let o=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[o]=r}}}}getVertexPosition(e,t){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(s,e);let o=this.morphTargetInfluences;if(r&&o){ha.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let h=o[l],d=r[l];h!==0&&(Nl.fromBufferAttribute(d,e),a?ha.addScaledVector(Nl,h):ha.addScaledVector(Nl.sub(t),h))}t.add(ha)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),aa.copy(n.boundingSphere),aa.applyMatrix4(r),Ni.copy(e.ray).recast(e.near),!(aa.containsPoint(Ni.origin)===!1&&(Ni.intersectSphere(aa,jh)===null||Ni.origin.distanceToSquared(jh)>(e.far-e.near)**2))&&(Jh.copy(r).invert(),Ni.copy(e.ray).applyMatrix4(Jh),!(n.boundingBox!==null&&Ni.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(e,t,Ni)))}_computeIntersections(e,t,n){let s,r=this.geometry,a=this.material,o=r.index,l=r.attributes.position,c=r.attributes.uv,h=r.attributes.uv1,d=r.attributes.normal,u=r.groups,f=r.drawRange;if(o!==null)if(Array.isArray(a))for(let g=0,b=u.length;g<b;g++){let p=u[g],m=a[p.materialIndex],S=Math.max(p.start,f.start),C=Math.min(o.count,Math.min(p.start+p.count,f.start+f.count));for(let E=S,P=C;E<P;E+=3){let R=o.getX(E),_=o.getX(E+1),w=o.getX(E+2);s=da(this,m,e,n,c,h,d,R,_,w),s&&(s.faceIndex=Math.floor(E/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,f.start),b=Math.min(o.count,f.start+f.count);for(let p=g,m=b;p<m;p+=3){let S=o.getX(p),C=o.getX(p+1),E=o.getX(p+2);s=da(this,a,e,n,c,h,d,S,C,E),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(a))for(let g=0,b=u.length;g<b;g++){let p=u[g],m=a[p.materialIndex],S=Math.max(p.start,f.start),C=Math.min(l.count,Math.min(p.start+p.count,f.start+f.count));for(let E=S,P=C;E<P;E+=3){let R=E,_=E+1,w=E+2;s=da(this,m,e,n,c,h,d,R,_,w),s&&(s.faceIndex=Math.floor(E/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,f.start),b=Math.min(l.count,f.start+f.count);for(let p=g,m=b;p<m;p+=3){let S=p,C=p+1,E=p+2;s=da(this,a,e,n,c,h,d,S,C,E),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}}};function zp(i,e,t,n,s,r,a,o){let l;if(e.side===qt?l=n.intersectTriangle(a,r,s,!0,o):l=n.intersectTriangle(s,r,a,e.side===Fn,o),l===null)return null;ua.copy(o),ua.applyMatrix4(i.matrixWorld);let c=t.ray.origin.distanceTo(ua);return c<t.near||c>t.far?null:{distance:c,point:ua.clone(),object:i}}function da(i,e,t,n,s,r,a,o,l,c){i.getVertexPosition(o,oa),i.getVertexPosition(l,la),i.getVertexPosition(c,ca);let h=zp(i,e,t,n,oa,la,ca,Qh);if(h){let d=new k;Pn.getBarycoord(Qh,oa,la,ca,d),s&&(h.uv=Pn.getInterpolatedAttribute(s,o,l,c,d,new Oe)),r&&(h.uv1=Pn.getInterpolatedAttribute(r,o,l,c,d,new Oe)),a&&(h.normal=Pn.getInterpolatedAttribute(a,o,l,c,d,new k),h.normal.dot(n.direction)>0&&h.normal.multiplyScalar(-1));let u={a:o,b:l,c,normal:new k,materialIndex:0};Pn.getNormal(oa,la,ca,u.normal),h.face=u,h.barycoord=d}return h}var Oi=class extends zt{constructor(e=null,t=1,n=1,s,r,a,o,l,c=Lt,h=Lt,d,u){super(null,a,o,l,c,h,s,r,d,u),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var Ui=new fi,Gp=new Oe(.5,.5),fa=new k,mi=class{constructor(e=new sn,t=new sn,n=new sn,s=new sn,r=new sn,a=new sn){this.planes=[e,t,n,s,r,a]}set(e,t,n,s,r,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(s),o[4].copy(r),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=fn,n=!1){let s=this.planes,r=e.elements,a=r[0],o=r[1],l=r[2],c=r[3],h=r[4],d=r[5],u=r[6],f=r[7],g=r[8],b=r[9],p=r[10],m=r[11],S=r[12],C=r[13],E=r[14],P=r[15];if(s[0].setComponents(c-a,f-h,m-g,P-S).normalize(),s[1].setComponents(c+a,f+h,m+g,P+S).normalize(),s[2].setComponents(c+o,f+d,m+b,P+C).normalize(),s[3].setComponents(c-o,f-d,m-b,P-C).normalize(),n)s[4].setComponents(l,u,p,E).normalize(),s[5].setComponents(c-l,f-u,m-p,P-E).normalize();else if(s[4].setComponents(c-l,f-u,m-p,P-E).normalize(),t===fn)s[5].setComponents(c+l,f+u,m+p,P+E).normalize();else if(t===ps)s[5].setComponents(l,u,p,E).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Ui.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Ui.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Ui)}intersectsSprite(e){Ui.center.set(0,0,0);let t=Gp.distanceTo(e.center);return Ui.radius=.7071067811865476+t,Ui.applyMatrix4(e.matrixWorld),this.intersectsSphere(Ui)}intersectsSphere(e){let t=this.planes,n=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let s=t[n];if(fa.x=s.normal.x>0?e.max.x:e.min.x,fa.y=s.normal.y>0?e.max.y:e.min.y,fa.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(fa)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},eu=new ht,Ia=class i{constructor(){this.coordinateSystem=fn,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let s=0;s<t.length;s++){let r=t[s];eu.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new mi),n[s].setFromProjectionMatrix(eu,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new mi),t[s].copy(n[s]);return this._count=e._count,this}clone(){return new i().copy(this)}};var nr=class extends zt{constructor(e=[],t=Vi,n,s,r,a,o,l,c,h){super(e,t,n,s,r,a,o,l,c,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var ti=class extends zt{constructor(e,t,n=bn,s,r,a,o=Lt,l=Lt,c,h=Qn,d=1){if(h!==Qn&&h!==ii)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let u={width:e,height:t,depth:d};super(u,s,r,a,o,l,h,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new ys(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},ir=class extends ti{constructor(e,t=bn,n=Vi,s,r,a=Lt,o=Lt,l,c=Qn){let h={width:e,height:e,depth:1},d=[h,h,h,h,h,h];super(e,e,t,n,s,r,a,o,l,c),this.image=d,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},sr=class extends zt{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},vs=class i extends Dn{constructor(e=1,t=1,n=1,s=1,r=1,a=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:n,widthSegments:s,heightSegments:r,depthSegments:a};let o=this;s=Math.floor(s),r=Math.floor(r),a=Math.floor(a);let l=[],c=[],h=[],d=[],u=0,f=0;g("z","y","x",-1,-1,n,t,e,a,r,0),g("z","y","x",1,-1,n,t,-e,a,r,1),g("x","z","y",1,1,e,n,t,s,a,2),g("x","z","y",1,-1,e,n,-t,s,a,3),g("x","y","z",1,-1,e,t,n,s,r,4),g("x","y","z",-1,-1,e,t,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new pn(c,3)),this.setAttribute("normal",new pn(h,3)),this.setAttribute("uv",new pn(d,2));function g(b,p,m,S,C,E,P,R,_,w,H){let O=E/_,z=P/w,$=E/2,te=P/2,U=R/2,j=_+1,ie=w+1,Z=0,he=0,K=new k;for(let oe=0;oe<ie;oe++){let le=oe*z-te;for(let Re=0;Re<j;Re++){let Ne=Re*O-$;K[b]=Ne*S,K[p]=le*C,K[m]=U,c.push(K.x,K.y,K.z),K[b]=0,K[p]=0,K[m]=R>0?1:-1,h.push(K.x,K.y,K.z),d.push(Re/_),d.push(1-oe/w),Z+=1}}for(let oe=0;oe<w;oe++)for(let le=0;le<_;le++){let Re=u+le+j*oe,Ne=u+le+j*(oe+1),se=u+(le+1)+j*(oe+1),ye=u+(le+1)+j*oe;l.push(Re,Ne,ye),l.push(Ne,se,ye),he+=6}o.addGroup(f,he,H),f+=he,u+=Z}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var Bi=class i extends Dn{constructor(e=1,t=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:n,heightSegments:s};let r=e/2,a=t/2,o=Math.floor(n),l=Math.floor(s),c=o+1,h=l+1,d=e/o,u=t/l,f=[],g=[],b=[],p=[];for(let m=0;m<h;m++){let S=m*u-a;for(let C=0;C<c;C++){let E=C*d-r;g.push(E,-S,0),b.push(0,0,1),p.push(C/o),p.push(1-m/l)}}for(let m=0;m<l;m++)for(let S=0;S<o;S++){let C=S+c*m,E=S+c*(m+1),P=S+1+c*(m+1),R=S+1+c*m;f.push(C,E,R),f.push(E,P,R)}this.setIndex(f),this.setAttribute("position",new pn(g,3)),this.setAttribute("normal",new pn(b,3)),this.setAttribute("uv",new pn(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.widthSegments,e.heightSegments)}};function Wi(i){let e={};for(let t in i){e[t]={};for(let n in i[t]){let s=i[t][n];if(tu(s))s.isRenderTargetTexture?(De("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][n]=null):e[t][n]=s.clone();else if(Array.isArray(s))if(tu(s[0])){let r=[];for(let a=0,o=s.length;a<o;a++)r[a]=s[a].clone();e[t][n]=r}else e[t][n]=s.slice();else e[t][n]=s}}return e}function Vt(i){let e={};for(let t=0;t<i.length;t++){let n=Wi(i[t]);for(let s in n)e[s]=n[s]}return e}function tu(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function Vp(i){let e=[];for(let t=0;t<i.length;t++)e.push(i[t].clone());return e}function _c(i){let e=i.getRenderTarget();return e===null?i.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:Ze.workingColorSpace}var $u={clone:Wi,merge:Vt},Hp=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Wp=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Nn=class extends pi{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Hp,this.fragmentShader=Wp,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Wi(e.uniforms),this.uniformsGroups=Vp(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let a=this.uniforms[s].value;a&&a.isTexture?t.uniforms[s]={type:"t",value:a.toJSON(e).uuid}:a&&a.isColor?t.uniforms[s]={type:"c",value:a.getHex()}:a&&a.isVector2?t.uniforms[s]={type:"v2",value:a.toArray()}:a&&a.isVector3?t.uniforms[s]={type:"v3",value:a.toArray()}:a&&a.isVector4?t.uniforms[s]={type:"v4",value:a.toArray()}:a&&a.isMatrix3?t.uniforms[s]={type:"m3",value:a.toArray()}:a&&a.isMatrix4?t.uniforms[s]={type:"m4",value:a.toArray()}:t.uniforms[s]={value:a}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let s=e.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=t[s.value]||null;break;case"c":this.uniforms[n].value=new Ve().setHex(s.value);break;case"v2":this.uniforms[n].value=new Oe().fromArray(s.value);break;case"v3":this.uniforms[n].value=new k().fromArray(s.value);break;case"v4":this.uniforms[n].value=new mt().fromArray(s.value);break;case"m3":this.uniforms[n].value=new ke().fromArray(s.value);break;case"m4":this.uniforms[n].value=new ht().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let n in e.extensions)this.extensions[n]=e.extensions[n];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},La=class extends Nn{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}},ki=class extends pi{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type="MeshStandardMaterial",this.defines={STANDARD:""},this.color=new Ve(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new Ve(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Lo,this.normalScale=new Oe(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new ei,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:""},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}};var Da=class extends pi{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=Lu,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Na=class extends pi{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function ls(i,e){return!i||i.constructor===e?i:typeof e.BYTES_PER_ELEMENT=="number"?new e(i):Array.prototype.slice.call(i)}function pa(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var gi=class{constructor(e,t,n,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(n),this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,s=t[n],r=t[n-1];n:{e:{let a;t:{i:if(!(e<s)){for(let o=n+2;;){if(s===void 0){if(e<r)break i;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===o)break;if(r=s,s=t[++n],e<s)break e}a=t.length;break t}if(!(e>=r)){let o=t[1];e<o&&(n=2,r=o);for(let l=n-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===l)break;if(s=r,r=t[--n-1],e>=r)break e}a=n,n=0;break t}break n}for(;n<a;){let o=n+a>>>1;e<t[o]?a=o:n=o+1}if(s=t[n],r=t[n-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=e*s;for(let a=0;a!==s;++a)t[a]=n[r+a];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},Ua=class extends gi{constructor(e,t,n,s){super(e,t,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:Ol,endingEnd:Ol}}intervalChanged_(e,t,n){let s=this.parameterPositions,r=e-2,a=e+1,o=s[r],l=s[a];if(o===void 0)switch(this.getSettings_().endingStart){case Bl:r=e,o=2*t-n;break;case kl:r=s.length-2,o=t+s[r]-s[r+1];break;default:r=e,o=n}if(l===void 0)switch(this.getSettings_().endingEnd){case Bl:a=e,l=2*n-t;break;case kl:a=1,l=n+s[1]-s[0];break;default:a=e-1,l=t}let c=(n-t)*.5,h=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(l-n),this._offsetPrev=r*h,this._offsetNext=a*h}interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=e*o,c=l-o,h=this._offsetPrev,d=this._offsetNext,u=this._weightPrev,f=this._weightNext,g=(n-t)/(s-t),b=g*g,p=b*g,m=-u*p+2*u*b-u*g,S=(1+u)*p+(-1.5-2*u)*b+(-.5+u)*g+1,C=(-1-f)*p+(1.5+f)*b+.5*g,E=f*p-f*b;for(let P=0;P!==o;++P)r[P]=m*a[h+P]+S*a[c+P]+C*a[l+P]+E*a[d+P];return r}},Fa=class extends gi{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=e*o,c=l-o,h=(n-t)/(s-t),d=1-h;for(let u=0;u!==o;++u)r[u]=a[c+u]*d+a[l+u]*h;return r}},Oa=class extends gi{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e){return this.copySampleValue_(e-1)}},Ba=class extends gi{interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=e*o,c=l-o,h=this.inTangents,d=this.outTangents;if(!h||!d){let g=(n-t)/(s-t),b=1-g;for(let p=0;p!==o;++p)r[p]=a[c+p]*b+a[l+p]*g;return r}let u=o*2,f=e-1;for(let g=0;g!==o;++g){let b=a[c+g],p=a[l+g],m=f*u+g*2,S=d[m],C=d[m+1],E=e*u+g*2,P=h[E],R=h[E+1],_=qp(n,t,S,P,s);r[g]=Zu(_,b,C,R,p)}return r}};function Zu(i,e,t,n,s){let r=1-i;return r*r*r*e+3*r*r*i*t+3*r*i*i*n+i*i*i*s}function Xp(i,e,t,n,s){let r=1-i;return 3*r*r*(t-e)+6*r*i*(n-t)+3*i*i*(s-n)}function qp(i,e,t,n,s){let r=(i-e)/(s-e);for(let a=0;a<8;a++){let o=Zu(r,e,t,n,s)-i;if(Math.abs(o)<1e-10)break;let l=Xp(r,e,t,n,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-o/l))}return r}var cn=class{constructor(e,t,n,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=ls(t,this.TimeBufferType),this.values=ls(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:ls(e.times,Array),values:ls(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(n.interpolation=s),pa(e.settings)&&(n.settings={inTangents:ls(e.settings.inTangents,Array),outTangents:ls(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new Oa(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Fa(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new Ua(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Ba(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case qs:t=this.InterpolantFactoryMethodDiscrete;break;case Ta:t=this.InterpolantFactoryMethodLinear;break;case ya:t=this.InterpolantFactoryMethodSmooth;break;case Fl:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return De("KeyframeTrack:",n),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return qs;case this.InterpolantFactoryMethodLinear:return Ta;case this.InterpolantFactoryMethodSmooth:return ya;case this.InterpolantFactoryMethodBezier:return Fl}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]+=e;pa(this.settings)&&(nu(this.settings.inTangents,e),nu(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]*=e;pa(this.settings)&&(iu(this.settings.inTangents,e),iu(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,s=n.length,r=0,a=s-1;for(;r!==s&&n[r]<e;)++r;for(;a!==-1&&n[a]>t;)--a;if(++a,r!==0||a!==s){r>=a&&(a=Math.max(a,1),r=a-1);let o=this.getValueSize();this.times=n.slice(r,a),this.values=this.values.slice(r*o,a*o)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Fe("KeyframeTrack: Invalid value size in track.",this),e=!1);let n=this.times,s=this.values,r=n.length;r===0&&(Fe("KeyframeTrack: Track is empty.",this),e=!1);let a=null;for(let o=0;o!==r;o++){let l=n[o];if(typeof l=="number"&&isNaN(l)){Fe("KeyframeTrack: Time is not a valid number.",this,o,l),e=!1;break}if(a!==null&&a>l){Fe("KeyframeTrack: Out of order keys.",this,o,l,a),e=!1;break}a=l}if(s!==void 0&&rp(s))for(let o=0,l=s.length;o!==l;++o){let c=s[o];if(isNaN(c)){Fe("KeyframeTrack: Value is not a valid number.",this,o,c),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===ya,r=e.length-1,a=1;for(let o=1;o<r;++o){let l=!1,c=e[o],h=e[o+1];if(c!==h&&(o!==1||c!==e[0]))if(s)l=!0;else{let d=o*n,u=d-n,f=d+n;for(let g=0;g!==n;++g){let b=t[d+g];if(b!==t[u+g]||b!==t[f+g]){l=!0;break}}}if(l){if(o!==a){e[a]=e[o];let d=o*n,u=a*n;for(let f=0;f!==n;++f)t[u+f]=t[d+f]}++a}}if(r>0){e[a]=e[r];for(let o=r*n,l=a*n,c=0;c!==n;++c)t[l+c]=t[o+c];++a}return a!==e.length?(this.times=e.slice(0,a),this.values=t.slice(0,a*n)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,s=new n(this.name,e,t);return s.createInterpolant=this.createInterpolant,pa(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function nu(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]+=e}function iu(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]*=e}cn.prototype.ValueTypeName="";cn.prototype.TimeBufferType=Float32Array;cn.prototype.ValueBufferType=Float32Array;cn.prototype.DefaultInterpolation=Ta;var yi=class extends cn{constructor(e,t,n){super(e,t,n)}};yi.prototype.ValueTypeName="bool";yi.prototype.ValueBufferType=Array;yi.prototype.DefaultInterpolation=qs;yi.prototype.InterpolantFactoryMethodLinear=void 0;yi.prototype.InterpolantFactoryMethodSmooth=void 0;var ka=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}};ka.prototype.ValueTypeName="color";var za=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}};za.prototype.ValueTypeName="number";var Ga=class extends gi{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=(n-t)/(s-t),c=e*o;for(let h=c+o;c!==h;c+=4)an.slerpFlat(r,0,a,c-o,a,c,l);return r}},rr=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}InterpolantFactoryMethodLinear(e){return new Ga(this.times,this.values,this.getValueSize(),e)}};rr.prototype.ValueTypeName="quaternion";rr.prototype.InterpolantFactoryMethodSmooth=void 0;var _i=class extends cn{constructor(e,t,n){super(e,t,n)}};_i.prototype.ValueTypeName="string";_i.prototype.ValueBufferType=Array;_i.prototype.DefaultInterpolation=qs;_i.prototype.InterpolantFactoryMethodLinear=void 0;_i.prototype.InterpolantFactoryMethodSmooth=void 0;var Va=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}};Va.prototype.ValueTypeName="vector";var Ha=class{constructor(e,t,n){let s=this,r=!1,a=0,o=0,l,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=n,this._abortController=null,this.itemStart=function(h){o++,r===!1&&s.onStart!==void 0&&s.onStart(h,a,o),r=!0},this.itemEnd=function(h){a++,s.onProgress!==void 0&&s.onProgress(h,a,o),a===o&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(h){s.onError!==void 0&&s.onError(h)},this.resolveURL=function(h){return h=h.normalize("NFC"),l?l(h):h},this.setURLModifier=function(h){return l=h,this},this.addHandler=function(h,d){return c.push(h,d),this},this.removeHandler=function(h){let d=c.indexOf(h);return d!==-1&&c.splice(d,2),this},this.getHandler=function(h){for(let d=0,u=c.length;d<u;d+=2){let f=c[d],g=c[d+1];if(f.global&&(f.lastIndex=0),f.test(h))return g}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},Ku=new Ha,Wa=class{constructor(e){this.manager=e!==void 0?e:Ku,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let n=this;return new Promise(function(s,r){n.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};Wa.DEFAULT_MATERIAL_NAME="__DEFAULT";var ar=class extends Xt{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type="Light",this.color=new Ve(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}};var Ul=new ht,su=new k,ru=new k,Xa=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new Oe(512,512),this.mapType=jt,this.map=null,this.mapPass=null,this.matrix=new ht,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new mi,this._frameExtents=new Oe(1,1),this._viewportCount=1,this._viewports=[new mt(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;su.setFromMatrixPosition(e.matrixWorld),t.position.copy(su),ru.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(ru),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,s){Ul.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix(Ul,e.coordinateSystem,e.reversedDepth);let r=this._frameExtents,a=s?s.z/r.x:1,o=s?s.w/r.y:1,l=s?s.x/r.x:0,c=s?s.y/r.y:0;e.coordinateSystem===ps||e.reversedDepth?t.set(.5*a,0,0,.5*a+l,0,.5*o,0,.5*o+c,0,0,1,0,0,0,0,1):t.set(.5*a,0,0,.5*a+l,0,.5*o,0,.5*o+c,0,0,.5,.5,0,0,0,1),t.multiply(Ul)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},ma=new k,ga=new an,Cn=new k,or=class extends Xt{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new ht,this.projectionMatrix=new ht,this.projectionMatrixInverse=new ht,this.coordinateSystem=fn,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(ma,ga,Cn),Cn.x===1&&Cn.y===1&&Cn.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(ma,ga,Cn.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(ma,ga,Cn),Cn.x===1&&Cn.y===1&&Cn.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(ma,ga,Cn.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},di=new k,au=new Oe,ou=new Oe,Wt=class extends or{constructor(e=50,t=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=gs*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Ws*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return gs*2*Math.atan(Math.tan(Ws*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){di.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(di.x,di.y).multiplyScalar(-e/di.z),di.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(di.x,di.y).multiplyScalar(-e/di.z)}getViewSize(e,t){return this.getViewBounds(e,au,ou),t.subVectors(ou,au)}setViewOffset(e,t,n,s,r,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Ws*.5*this.fov)/this.zoom,n=2*t,s=this.aspect*n,r=-.5*s,a=this.view;if(this.view!==null&&this.view.enabled){let l=a.fullWidth,c=a.fullHeight;r+=a.offsetX*s/l,t-=a.offsetY*n/c,s*=a.width/l,n*=a.height/c}let o=this.filmOffset;o!==0&&(r+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var lr=class extends or{constructor(e=-1,t=1,n=1,s=-1,r=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=s,this.near=r,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,s,r,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-e,a=n+e,o=s+t,l=s-t;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,a=r+c*this.view.width,o-=h*this.view.offsetY,l=o-h*this.view.height}this.projectionMatrix.makeOrthographic(r,a,o,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},zl=class extends Xa{constructor(){super(new lr(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},cr=class extends ar{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(Xt.DEFAULT_UP),this.updateMatrix(),this.target=new Xt,this.shadow=new zl}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}};var bs=class{constructor(){this.isSphericalHarmonics3=!0,this.coefficients=[];for(let e=0;e<9;e++)this.coefficients.push(new k)}set(e){for(let t=0;t<9;t++)this.coefficients[t].copy(e[t]);return this}zero(){for(let e=0;e<9;e++)this.coefficients[e].set(0,0,0);return this}getAt(e,t){let n=e.x,s=e.y,r=e.z,a=this.coefficients;return t.copy(a[0]).multiplyScalar(.282095),t.addScaledVector(a[1],.488603*s),t.addScaledVector(a[2],.488603*r),t.addScaledVector(a[3],.488603*n),t.addScaledVector(a[4],1.092548*(n*s)),t.addScaledVector(a[5],1.092548*(s*r)),t.addScaledVector(a[6],.315392*(3*r*r-1)),t.addScaledVector(a[7],1.092548*(n*r)),t.addScaledVector(a[8],.546274*(n*n-s*s)),t}getIrradianceAt(e,t){let n=e.x,s=e.y,r=e.z,a=this.coefficients;return t.copy(a[0]).multiplyScalar(.886227),t.addScaledVector(a[1],2*.511664*s),t.addScaledVector(a[2],2*.511664*r),t.addScaledVector(a[3],2*.511664*n),t.addScaledVector(a[4],2*.429043*n*s),t.addScaledVector(a[5],2*.429043*s*r),t.addScaledVector(a[6],.743125*r*r-.247708),t.addScaledVector(a[7],2*.429043*n*r),t.addScaledVector(a[8],.429043*(n*n-s*s)),t}add(e){for(let t=0;t<9;t++)this.coefficients[t].add(e.coefficients[t]);return this}addScaledSH(e,t){for(let n=0;n<9;n++)this.coefficients[n].addScaledVector(e.coefficients[n],t);return this}scale(e){for(let t=0;t<9;t++)this.coefficients[t].multiplyScalar(e);return this}lerp(e,t){for(let n=0;n<9;n++)this.coefficients[n].lerp(e.coefficients[n],t);return this}equals(e){for(let t=0;t<9;t++)if(!this.coefficients[t].equals(e.coefficients[t]))return!1;return!0}copy(e){return this.set(e.coefficients)}clone(){return new this.constructor().copy(this)}fromArray(e,t=0){let n=this.coefficients;for(let s=0;s<9;s++)n[s].fromArray(e,t+s*3);return this}toArray(e=[],t=0){let n=this.coefficients;for(let s=0;s<9;s++)n[s].toArray(e,t+s*3);return e}static getBasisAt(e,t){let n=e.x,s=e.y,r=e.z;t[0]=.282095,t[1]=.488603*s,t[2]=.488603*r,t[3]=.488603*n,t[4]=1.092548*n*s,t[5]=1.092548*s*r,t[6]=.315392*(3*r*r-1),t[7]=1.092548*n*r,t[8]=.546274*(n*n-s*s)}},hr=class extends ar{constructor(e=new bs,t=1){super(void 0,t),this.isLightProbe=!0,this.type="LightProbe",this.sh=e}copy(e){return super.copy(e),this.sh.copy(e.sh),this}toJSON(e){let t=super.toJSON(e);return t.object.sh=this.sh.toArray(),t}};var cs=-90,hs=1,Ms=class extends Xt{constructor(e,t,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new Wt(cs,hs,e,t);s.layers=this.layers,this.add(s);let r=new Wt(cs,hs,e,t);r.layers=this.layers,this.add(r);let a=new Wt(cs,hs,e,t);a.layers=this.layers,this.add(a);let o=new Wt(cs,hs,e,t);o.layers=this.layers,this.add(o);let l=new Wt(cs,hs,e,t);l.layers=this.layers,this.add(l);let c=new Wt(cs,hs,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,s,r,a,o,l]=t;for(let c of t)this.remove(c);if(e===fn)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===ps)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,a,o,l,c,h]=this.children,d=e.getRenderTarget(),u=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),g=e.xr.enabled;e.xr.enabled=!1;let b=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let p=!1;e.isWebGLRenderer===!0?p=e.state.buffers.depth.getReversed():p=e.reversedDepthBuffer,e.setRenderTarget(n,0,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(n,1,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(n,4,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=b,e.setRenderTarget(n,5,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,h),e.setRenderTarget(d,u,f),e.xr.enabled=g,n.texture.needsPMREMUpdate=!0}},qa=class extends Wt{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var xc="\\[\\]\\.:\\/",Yp=new RegExp("["+xc+"]","g"),vc="[^"+xc+"]",$p="[^"+xc.replace("\\.","")+"]",Zp=/((?:WC+[\/:])*)/.source.replace("WC",vc),Kp=/(WCOD+)?/.source.replace("WCOD",$p),Jp=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",vc),jp=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",vc),Qp=new RegExp("^"+Zp+Kp+Jp+jp+"$"),em=["material","materials","bones","map"],Gl=class{constructor(e,t,n){let s=n||pt.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},pt=class i{constructor(e,t,n){this.path=t,this.parsedPath=n||i.parseTrackName(t),this.node=i.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,n){return e&&e.isAnimationObjectGroup?new i.Composite(e,t,n):new i(e,t,n)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace(Yp,"")}static parseTrackName(e){let t=Qp.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);em.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return n}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(r){for(let a=0;a<r.length;a++){let o=r[a];if(o.name===t||o.uuid===t)return o;let l=n(o.children);if(l)return l}return null},s=n(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)e[t++]=n[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,n=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=i.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){De("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=t.objectIndex;switch(n){case"materials":if(!e.material){Fe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){Fe("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){Fe("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let h=0;h<e.length;h++)if(e[h].name===c){c=h;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){Fe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){Fe("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[n]===void 0){Fe("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[n]}if(c!==void 0){if(e[c]===void 0){Fe("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[c]}}let a=e[s];if(a===void 0){let c=t.nodeName;Fe("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",e);return}let o=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?o=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(o=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){Fe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){Fe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=a,this.propertyIndex=r}else a.fromArray!==void 0&&a.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=a):Array.isArray(a)?(l=this.BindingType.EntireArray,this.resolvedProperty=a):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][o]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};pt.Composite=Gl;pt.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};pt.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};pt.prototype.GetterByBindingType=[pt.prototype._getValue_direct,pt.prototype._getValue_array,pt.prototype._getValue_arrayElement,pt.prototype._getValue_toArray];pt.prototype.SetterByBindingTypeAndVersioning=[[pt.prototype._setValue_direct,pt.prototype._setValue_direct_setNeedsUpdate,pt.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[pt.prototype._setValue_array,pt.prototype._setValue_array_setNeedsUpdate,pt.prototype._setValue_array_setMatrixWorldNeedsUpdate],[pt.prototype._setValue_arrayElement,pt.prototype._setValue_arrayElement_setNeedsUpdate,pt.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[pt.prototype._setValue_fromArray,pt.prototype._setValue_fromArray_setNeedsUpdate,pt.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var Wb=new Float32Array(1);var Un=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=Xe(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(Xe(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var Vl=class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=n,r[3]=s,this}};var ur=class extends rn{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function bc(i,e,t,n){let s=tm(n);switch(t){case oc:return i*e;case cc:return i*e/s.components*s.byteLength;case ja:return i*e/s.components*s.byteLength;case bi:return i*e*2/s.components*s.byteLength;case Qa:return i*e*2/s.components*s.byteLength;case lc:return i*e*3/s.components*s.byteLength;case Sn:return i*e*4/s.components*s.byteLength;case eo:return i*e*4/s.components*s.byteLength;case mr:case gr:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case yr:case _r:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case no:case so:return Math.max(i,16)*Math.max(e,8)/4;case to:case io:return Math.max(i,8)*Math.max(e,8)/2;case ro:case ao:case lo:case co:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case oo:case xr:case ho:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case uo:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case fo:return Math.floor((i+4)/5)*Math.floor((e+3)/4)*16;case po:return Math.floor((i+4)/5)*Math.floor((e+4)/5)*16;case mo:return Math.floor((i+5)/6)*Math.floor((e+4)/5)*16;case go:return Math.floor((i+5)/6)*Math.floor((e+5)/6)*16;case yo:return Math.floor((i+7)/8)*Math.floor((e+4)/5)*16;case _o:return Math.floor((i+7)/8)*Math.floor((e+5)/6)*16;case xo:return Math.floor((i+7)/8)*Math.floor((e+7)/8)*16;case vo:return Math.floor((i+9)/10)*Math.floor((e+4)/5)*16;case bo:return Math.floor((i+9)/10)*Math.floor((e+5)/6)*16;case Mo:return Math.floor((i+9)/10)*Math.floor((e+7)/8)*16;case So:return Math.floor((i+9)/10)*Math.floor((e+9)/10)*16;case wo:return Math.floor((i+11)/12)*Math.floor((e+9)/10)*16;case Eo:return Math.floor((i+11)/12)*Math.floor((e+11)/12)*16;case Ao:case To:case Ro:return Math.ceil(i/4)*Math.ceil(e/4)*16;case Co:case Po:return Math.ceil(i/4)*Math.ceil(e/4)*8;case vr:case Io:return Math.ceil(i/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function tm(i){switch(i){case jt:case ic:return{byteLength:1,components:1};case Ts:case sc:case hn:return{byteLength:2,components:1};case Ka:case Ja:return{byteLength:2,components:4};case bn:case Za:case Mn:return{byteLength:4,components:1};case rc:case ac:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?De("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function _d(){let i=null,e=!1,t=null,n=null;function s(r,a){n=i.requestAnimationFrame(s),t(r,a)}return{start:function(){e!==!0&&t!==null&&i!==null&&(n=i.requestAnimationFrame(s),e=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){i=r}}}function im(i){let e=new WeakMap;function t(o,l){let c=o.array,h=o.usage,d=c.byteLength,u=i.createBuffer();i.bindBuffer(l,u),i.bufferData(l,c,h),o.onUploadCallback();let f;if(c instanceof Float32Array)f=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)f=i.HALF_FLOAT;else if(c instanceof Uint16Array)o.isFloat16BufferAttribute?f=i.HALF_FLOAT:f=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)f=i.SHORT;else if(c instanceof Uint32Array)f=i.UNSIGNED_INT;else if(c instanceof Int32Array)f=i.INT;else if(c instanceof Int8Array)f=i.BYTE;else if(c instanceof Uint8Array)f=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)f=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:u,type:f,bytesPerElement:c.BYTES_PER_ELEMENT,version:o.version,size:d}}function n(o,l,c){let h=l.array,d=l.updateRanges;if(i.bindBuffer(c,o),d.length===0)i.bufferSubData(c,0,h);else{d.sort((f,g)=>f.start-g.start);let u=0;for(let f=1;f<d.length;f++){let g=d[u],b=d[f];b.start<=g.start+g.count+1?g.count=Math.max(g.count,b.start+b.count-g.start):(++u,d[u]=b)}d.length=u+1;for(let f=0,g=d.length;f<g;f++){let b=d[f];i.bufferSubData(c,b.start*h.BYTES_PER_ELEMENT,h,b.start,b.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(o){return o.isInterleavedBufferAttribute&&(o=o.data),e.get(o)}function r(o){o.isInterleavedBufferAttribute&&(o=o.data);let l=e.get(o);l&&(i.deleteBuffer(l.buffer),e.delete(o))}function a(o,l){if(o.isInterleavedBufferAttribute&&(o=o.data),o.isGLBufferAttribute){let h=e.get(o);(!h||h.version<o.version)&&e.set(o,{buffer:o.buffer,type:o.type,bytesPerElement:o.elementSize,version:o.version});return}let c=e.get(o);if(c===void 0)e.set(o,t(o,l));else if(c.version<o.version){if(c.size!==o.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,o,l),c.version=o.version}}return{get:s,remove:r,update:a}}var sm=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,rm=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,am=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,om=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,lm=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,cm=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,hm=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,um=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,dm=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,fm=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,pm=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,mm=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,gm=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,ym=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,_m=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,xm=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,vm=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,bm=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,Mm=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,Sm=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,wm=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,Em=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,Am=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,Tm=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,Rm=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,Cm=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,Pm=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Im=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Lm=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,Dm="gl_FragColor = linearToOutputTexel( gl_FragColor );",Nm=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Um=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,Fm=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,Om=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,Bm=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,km=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,zm=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,Gm=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Vm=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Hm=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Wm=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Xm=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,qm=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Ym=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,$m=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,Zm=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,Km=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Jm=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,jm=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Qm=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,eg=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,tg=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,ng=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,ig=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,sg=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,rg=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,ag=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,og=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,lg=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,cg=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,hg=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,ug=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,dg=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,fg=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,pg=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,mg=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,gg=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,yg=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,_g=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,xg=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,vg=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,bg=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,Mg=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,Sg=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,wg=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,Eg=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,Ag=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,Tg=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,Rg=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,Cg=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,Pg=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,Ig=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,Lg=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,Dg=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,Ng=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,Ug=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,Fg=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,Og=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,Bg=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,kg=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,zg=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,Gg=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,Vg=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,Hg=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,Wg=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,Xg=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,qg=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,Yg=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,$g=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,Zg=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,Kg=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,Jg=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,jg=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,Qg=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,e0=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,t0=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,n0=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,i0=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,s0=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,r0=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,a0=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,o0=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,l0=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,c0=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,h0=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,u0=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,d0=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,f0=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,p0=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,m0=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,g0=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,y0=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,_0=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,x0=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,v0=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,b0=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,M0=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,S0=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,w0=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,E0=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,A0=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,T0=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,R0=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,C0=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,P0=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,I0=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,L0=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,D0=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,N0=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,U0=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,F0=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,We={alphahash_fragment:sm,alphahash_pars_fragment:rm,alphamap_fragment:am,alphamap_pars_fragment:om,alphatest_fragment:lm,alphatest_pars_fragment:cm,aomap_fragment:hm,aomap_pars_fragment:um,batching_pars_vertex:dm,batching_vertex:fm,begin_vertex:pm,beginnormal_vertex:mm,bsdfs:gm,iridescence_fragment:ym,bumpmap_pars_fragment:_m,clipping_planes_fragment:xm,clipping_planes_pars_fragment:vm,clipping_planes_pars_vertex:bm,clipping_planes_vertex:Mm,color_fragment:Sm,color_pars_fragment:wm,color_pars_vertex:Em,color_vertex:Am,common:Tm,defaultnormal_vertex:Rm,displacementmap_pars_vertex:Cm,displacementmap_vertex:Pm,emissivemap_fragment:Im,emissivemap_pars_fragment:Lm,colorspace_fragment:Dm,colorspace_pars_fragment:Nm,envmap_fragment:Um,envmap_common_pars_fragment:Fm,envmap_pars_fragment:Om,envmap_pars_vertex:Bm,envmap_physical_pars_fragment:Zm,envmap_vertex:km,fog_vertex:zm,fog_pars_vertex:Gm,fog_fragment:Vm,fog_pars_fragment:Hm,gradientmap_pars_fragment:Wm,lightmap_pars_fragment:Xm,lights_lambert_fragment:qm,lights_lambert_pars_fragment:Ym,lights_pars_begin:$m,lights_toon_fragment:Km,lights_toon_pars_fragment:Jm,lights_phong_fragment:jm,lights_phong_pars_fragment:Qm,lights_physical_fragment:eg,lights_physical_pars_fragment:tg,lights_fragment_begin:ng,lights_fragment_maps:ig,lights_fragment_end:sg,lightprobes_pars_fragment:rg,logdepthbuf_fragment:ag,logdepthbuf_pars_fragment:og,logdepthbuf_pars_vertex:lg,logdepthbuf_vertex:cg,map_fragment:hg,map_pars_fragment:ug,map_particle_fragment:dg,map_particle_pars_fragment:fg,metalnessmap_fragment:pg,metalnessmap_pars_fragment:mg,morphinstance_vertex:gg,morphcolor_vertex:yg,morphnormal_vertex:_g,morphtarget_pars_vertex:xg,morphtarget_vertex:vg,normal_fragment_begin:bg,normal_fragment_maps:Mg,normal_pars_fragment:Sg,normal_pars_vertex:wg,normal_vertex:Eg,normalmap_pars_fragment:Ag,clearcoat_normal_fragment_begin:Tg,clearcoat_normal_fragment_maps:Rg,clearcoat_pars_fragment:Cg,iridescence_pars_fragment:Pg,opaque_fragment:Ig,packing:Lg,premultiplied_alpha_fragment:Dg,project_vertex:Ng,dithering_fragment:Ug,dithering_pars_fragment:Fg,roughnessmap_fragment:Og,roughnessmap_pars_fragment:Bg,shadowmap_pars_fragment:kg,shadowmap_pars_vertex:zg,shadowmap_vertex:Gg,shadowmask_pars_fragment:Vg,skinbase_vertex:Hg,skinning_pars_vertex:Wg,skinning_vertex:Xg,skinnormal_vertex:qg,specularmap_fragment:Yg,specularmap_pars_fragment:$g,tonemapping_fragment:Zg,tonemapping_pars_fragment:Kg,transmission_fragment:Jg,transmission_pars_fragment:jg,uv_pars_fragment:Qg,uv_pars_vertex:e0,uv_vertex:t0,worldpos_vertex:n0,background_vert:i0,background_frag:s0,backgroundCube_vert:r0,backgroundCube_frag:a0,cube_vert:o0,cube_frag:l0,depth_vert:c0,depth_frag:h0,distance_vert:u0,distance_frag:d0,equirect_vert:f0,equirect_frag:p0,linedashed_vert:m0,linedashed_frag:g0,meshbasic_vert:y0,meshbasic_frag:_0,meshlambert_vert:x0,meshlambert_frag:v0,meshmatcap_vert:b0,meshmatcap_frag:M0,meshnormal_vert:S0,meshnormal_frag:w0,meshphong_vert:E0,meshphong_frag:A0,meshphysical_vert:T0,meshphysical_frag:R0,meshtoon_vert:C0,meshtoon_frag:P0,points_vert:I0,points_frag:L0,shadow_vert:D0,shadow_frag:N0,sprite_vert:U0,sprite_frag:F0},ve={common:{diffuse:{value:new Ve(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new ke},alphaMap:{value:null},alphaMapTransform:{value:new ke},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new ke}},envmap:{envMap:{value:null},envMapRotation:{value:new ke},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new ke}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new ke}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new ke},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new ke},normalScale:{value:new Oe(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new ke},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new ke}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new ke}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new ke}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Ve(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Ve(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new ke},alphaTest:{value:0},uvTransform:{value:new ke}},sprite:{diffuse:{value:new Ve(16777215)},opacity:{value:1},center:{value:new Oe(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new ke},alphaMap:{value:null},alphaMapTransform:{value:new ke},alphaTest:{value:0}}},kn={basic:{uniforms:Vt([ve.common,ve.specularmap,ve.envmap,ve.aomap,ve.lightmap,ve.fog]),vertexShader:We.meshbasic_vert,fragmentShader:We.meshbasic_frag},lambert:{uniforms:Vt([ve.common,ve.specularmap,ve.envmap,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.fog,ve.lights,{emissive:{value:new Ve(0)},envMapIntensity:{value:1}}]),vertexShader:We.meshlambert_vert,fragmentShader:We.meshlambert_frag},phong:{uniforms:Vt([ve.common,ve.specularmap,ve.envmap,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.fog,ve.lights,{emissive:{value:new Ve(0)},specular:{value:new Ve(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:We.meshphong_vert,fragmentShader:We.meshphong_frag},standard:{uniforms:Vt([ve.common,ve.envmap,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.roughnessmap,ve.metalnessmap,ve.fog,ve.lights,{emissive:{value:new Ve(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:We.meshphysical_vert,fragmentShader:We.meshphysical_frag},toon:{uniforms:Vt([ve.common,ve.aomap,ve.lightmap,ve.emissivemap,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.gradientmap,ve.fog,ve.lights,{emissive:{value:new Ve(0)}}]),vertexShader:We.meshtoon_vert,fragmentShader:We.meshtoon_frag},matcap:{uniforms:Vt([ve.common,ve.bumpmap,ve.normalmap,ve.displacementmap,ve.fog,{matcap:{value:null}}]),vertexShader:We.meshmatcap_vert,fragmentShader:We.meshmatcap_frag},points:{uniforms:Vt([ve.points,ve.fog]),vertexShader:We.points_vert,fragmentShader:We.points_frag},dashed:{uniforms:Vt([ve.common,ve.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:We.linedashed_vert,fragmentShader:We.linedashed_frag},depth:{uniforms:Vt([ve.common,ve.displacementmap]),vertexShader:We.depth_vert,fragmentShader:We.depth_frag},normal:{uniforms:Vt([ve.common,ve.bumpmap,ve.normalmap,ve.displacementmap,{opacity:{value:1}}]),vertexShader:We.meshnormal_vert,fragmentShader:We.meshnormal_frag},sprite:{uniforms:Vt([ve.sprite,ve.fog]),vertexShader:We.sprite_vert,fragmentShader:We.sprite_frag},background:{uniforms:{uvTransform:{value:new ke},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:We.background_vert,fragmentShader:We.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new ke}},vertexShader:We.backgroundCube_vert,fragmentShader:We.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:We.cube_vert,fragmentShader:We.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:We.equirect_vert,fragmentShader:We.equirect_frag},distance:{uniforms:Vt([ve.common,ve.displacementmap,{referencePosition:{value:new k},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:We.distance_vert,fragmentShader:We.distance_frag},shadow:{uniforms:Vt([ve.lights,ve.fog,{color:{value:new Ve(0)},opacity:{value:1}}]),vertexShader:We.shadow_vert,fragmentShader:We.shadow_frag}};kn.physical={uniforms:Vt([kn.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new ke},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new ke},clearcoatNormalScale:{value:new Oe(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new ke},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new ke},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new ke},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new ke},sheen:{value:0},sheenColor:{value:new Ve(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new ke},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new ke},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new ke},transmissionSamplerSize:{value:new Oe},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new ke},attenuationDistance:{value:0},attenuationColor:{value:new Ve(0)},specularColor:{value:new Ve(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new ke},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new ke},anisotropyVector:{value:new Oe},anisotropyMap:{value:null},anisotropyMapTransform:{value:new ke}}]),vertexShader:We.meshphysical_vert,fragmentShader:We.meshphysical_frag};var Do={r:0,b:0,g:0},O0=new ht,xd=new ke;xd.set(-1,0,0,0,1,0,0,0,1);function B0(i,e,t,n,s,r){let a=new Ve(0),o=s===!0?0:1,l,c,h=null,d=0,u=null;function f(S){let C=S.isScene===!0?S.background:null;if(C&&C.isTexture){let E=S.backgroundBlurriness>0;C=e.get(C,E)}return C}function g(S){let C=!1,E=f(S);E===null?p(a,o):E&&E.isColor&&(p(E,1),C=!0);let P=i.xr.getEnvironmentBlendMode();P==="additive"?t.buffers.color.setClear(0,0,0,1,r):P==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(i.autoClear||C)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function b(S,C){let E=f(C);E&&E.isCubeTexture?(c===void 0&&(c=new Gt(new vs(1,1,1),new Nn({name:"BackgroundCubeMaterial",uniforms:Wi(kn.backgroundCube.uniforms),vertexShader:kn.backgroundCube.vertexShader,fragmentShader:kn.backgroundCube.fragmentShader,side:qt,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(P,R,_){this.matrixWorld.copyPosition(_.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=E,c.material.uniforms.backgroundBlurriness.value=C.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=C.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(O0.makeRotationFromEuler(C.backgroundRotation)).transpose(),E.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(xd),c.material.toneMapped=Ze.getTransfer(E.colorSpace)!==it,(h!==E||d!==E.version||u!==i.toneMapping)&&(c.material.needsUpdate=!0,h=E,d=E.version,u=i.toneMapping),c.layers.enableAll(),S.unshift(c,c.geometry,c.material,0,0,null)):E&&E.isTexture&&(l===void 0&&(l=new Gt(new Bi(2,2),new Nn({name:"BackgroundMaterial",uniforms:Wi(kn.background.uniforms),vertexShader:kn.background.vertexShader,fragmentShader:kn.background.fragmentShader,side:Fn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(l)),l.material.uniforms.t2D.value=E,l.material.uniforms.backgroundIntensity.value=C.backgroundIntensity,l.material.toneMapped=Ze.getTransfer(E.colorSpace)!==it,E.matrixAutoUpdate===!0&&E.updateMatrix(),l.material.uniforms.uvTransform.value.copy(E.matrix),(h!==E||d!==E.version||u!==i.toneMapping)&&(l.material.needsUpdate=!0,h=E,d=E.version,u=i.toneMapping),l.layers.enableAll(),S.unshift(l,l.geometry,l.material,0,0,null))}function p(S,C){S.getRGB(Do,_c(i)),t.buffers.color.setClear(Do.r,Do.g,Do.b,C,r)}function m(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return a},setClearColor:function(S,C=1){a.set(S),o=C,p(a,o)},getClearAlpha:function(){return o},setClearAlpha:function(S){o=S,p(a,o)},render:g,addToRenderList:b,dispose:m}}function k0(i,e){let t=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=u(null),r=s,a=!1;function o(z,$,te,U,j){let ie=!1,Z=d(z,U,te,$);r!==Z&&(r=Z,c(r.object)),ie=f(z,U,te,j),ie&&g(z,U,te,j),j!==null&&e.update(j,i.ELEMENT_ARRAY_BUFFER),(ie||a)&&(a=!1,E(z,$,te,U),j!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,e.get(j).buffer))}function l(){return i.createVertexArray()}function c(z){return i.bindVertexArray(z)}function h(z){return i.deleteVertexArray(z)}function d(z,$,te,U){let j=U.wireframe===!0,ie=n[$.id];ie===void 0&&(ie={},n[$.id]=ie);let Z=z.isInstancedMesh===!0?z.id:0,he=ie[Z];he===void 0&&(he={},ie[Z]=he);let K=he[te.id];K===void 0&&(K={},he[te.id]=K);let oe=K[j];return oe===void 0&&(oe=u(l()),K[j]=oe),oe}function u(z){let $=[],te=[],U=[];for(let j=0;j<t;j++)$[j]=0,te[j]=0,U[j]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:$,enabledAttributes:te,attributeDivisors:U,object:z,attributes:{},index:null}}function f(z,$,te,U){let j=r.attributes,ie=$.attributes,Z=0,he=te.getAttributes();for(let K in he)if(he[K].location>=0){let le=j[K],Re=ie[K];if(Re===void 0&&(K==="instanceMatrix"&&z.instanceMatrix&&(Re=z.instanceMatrix),K==="instanceColor"&&z.instanceColor&&(Re=z.instanceColor)),le===void 0||le.attribute!==Re||Re&&le.data!==Re.data)return!0;Z++}return r.attributesNum!==Z||r.index!==U}function g(z,$,te,U){let j={},ie=$.attributes,Z=0,he=te.getAttributes();for(let K in he)if(he[K].location>=0){let le=ie[K];le===void 0&&(K==="instanceMatrix"&&z.instanceMatrix&&(le=z.instanceMatrix),K==="instanceColor"&&z.instanceColor&&(le=z.instanceColor));let Re={};Re.attribute=le,le&&le.data&&(Re.data=le.data),j[K]=Re,Z++}r.attributes=j,r.attributesNum=Z,r.index=U}function b(){let z=r.newAttributes;for(let $=0,te=z.length;$<te;$++)z[$]=0}function p(z){m(z,0)}function m(z,$){let te=r.newAttributes,U=r.enabledAttributes,j=r.attributeDivisors;te[z]=1,U[z]===0&&(i.enableVertexAttribArray(z),U[z]=1),j[z]!==$&&(i.vertexAttribDivisor(z,$),j[z]=$)}function S(){let z=r.newAttributes,$=r.enabledAttributes;for(let te=0,U=$.length;te<U;te++)$[te]!==z[te]&&(i.disableVertexAttribArray(te),$[te]=0)}function C(z,$,te,U,j,ie,Z){Z===!0?i.vertexAttribIPointer(z,$,te,j,ie):i.vertexAttribPointer(z,$,te,U,j,ie)}function E(z,$,te,U){b();let j=U.attributes,ie=te.getAttributes(),Z=$.defaultAttributeValues;for(let he in ie){let K=ie[he];if(K.location>=0){let oe=j[he];if(oe===void 0&&(he==="instanceMatrix"&&z.instanceMatrix&&(oe=z.instanceMatrix),he==="instanceColor"&&z.instanceColor&&(oe=z.instanceColor)),oe!==void 0){let le=oe.normalized,Re=oe.itemSize,Ne=e.get(oe);if(Ne===void 0)continue;let se=Ne.buffer,ye=Ne.type,Se=Ne.bytesPerElement,Le=ye===i.INT||ye===i.UNSIGNED_INT||oe.gpuType===Za;if(oe.isInterleavedBufferAttribute){let _e=oe.data,Be=_e.isInterleavedBuffer===!0?_e.stride:_e.itemSize,ot=oe.offset;if(_e.isInstancedInterleavedBuffer||_e.isInstancedBufferAttribute){for(let Pe=0;Pe<K.locationSize;Pe++)m(K.location+Pe,_e.meshPerAttribute);z.isInstancedMesh!==!0&&U._maxInstanceCount===void 0&&(U._maxInstanceCount=_e.meshPerAttribute*_e.count)}else for(let Pe=0;Pe<K.locationSize;Pe++)p(K.location+Pe);i.bindBuffer(i.ARRAY_BUFFER,se);for(let Pe=0;Pe<K.locationSize;Pe++)C(K.location+Pe,Re/K.locationSize,ye,le,Be*Se,(ot+Re/K.locationSize*Pe)*Se,Le)}else{if(oe.isInstancedBufferAttribute){for(let _e=0;_e<K.locationSize;_e++)m(K.location+_e,oe.meshPerAttribute);z.isInstancedMesh!==!0&&U._maxInstanceCount===void 0&&(U._maxInstanceCount=oe.meshPerAttribute*oe.count)}else for(let _e=0;_e<K.locationSize;_e++)p(K.location+_e);i.bindBuffer(i.ARRAY_BUFFER,se);for(let _e=0;_e<K.locationSize;_e++)C(K.location+_e,Re/K.locationSize,ye,le,Re*Se,Re/K.locationSize*_e*Se,Le)}}else if(Z!==void 0){let le=Z[he];if(le!==void 0)switch(le.length){case 2:i.vertexAttrib2fv(K.location,le);break;case 3:i.vertexAttrib3fv(K.location,le);break;case 4:i.vertexAttrib4fv(K.location,le);break;default:i.vertexAttrib1fv(K.location,le)}}}}S()}function P(){H();for(let z in n){let $=n[z];for(let te in $){let U=$[te];for(let j in U){let ie=U[j];for(let Z in ie)h(ie[Z].object),delete ie[Z];delete U[j]}}delete n[z]}}function R(z){if(n[z.id]===void 0)return;let $=n[z.id];for(let te in $){let U=$[te];for(let j in U){let ie=U[j];for(let Z in ie)h(ie[Z].object),delete ie[Z];delete U[j]}}delete n[z.id]}function _(z){for(let $ in n){let te=n[$];for(let U in te){let j=te[U];if(j[z.id]===void 0)continue;let ie=j[z.id];for(let Z in ie)h(ie[Z].object),delete ie[Z];delete j[z.id]}}}function w(z){for(let $ in n){let te=n[$],U=z.isInstancedMesh===!0?z.id:0,j=te[U];if(j!==void 0){for(let ie in j){let Z=j[ie];for(let he in Z)h(Z[he].object),delete Z[he];delete j[ie]}delete te[U],Object.keys(te).length===0&&delete n[$]}}}function H(){O(),a=!0,r!==s&&(r=s,c(r.object))}function O(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:o,reset:H,resetDefaultState:O,dispose:P,releaseStatesOfGeometry:R,releaseStatesOfObject:w,releaseStatesOfProgram:_,initAttributes:b,enableAttribute:p,disableUnusedAttributes:S}}function z0(i,e,t){let n;function s(l){n=l}function r(l,c){i.drawArrays(n,l,c),t.update(c,n,1)}function a(l,c,h){h!==0&&(i.drawArraysInstanced(n,l,c,h),t.update(c,n,h))}function o(l,c,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,l,0,c,0,h);let u=0;for(let f=0;f<h;f++)u+=c[f];t.update(u,n,1)}this.setMode=s,this.render=r,this.renderInstances=a,this.renderMultiDraw=o}function G0(i,e,t,n){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let _=e.get("EXT_texture_filter_anisotropic");s=i.getParameter(_.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function a(_){return!(_!==Sn&&n.convert(_)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function o(_){let w=_===hn&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(_!==jt&&_!==Mn&&!w&&n.convert(_)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function l(_){if(_==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";_="mediump"}return _==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp",h=l(c);h!==c&&(De("WebGLRenderer:",c,"not supported, using",h,"instead."),c=h);let d=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),u=t.logarithmicDepthBuffer===!0&&d===!1;t.reversedDepthBuffer===!0&&d===!1&&De("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&d===!0&&De("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),g=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),b=i.getParameter(i.MAX_TEXTURE_SIZE),p=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),m=i.getParameter(i.MAX_VERTEX_ATTRIBS),S=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),C=i.getParameter(i.MAX_VARYING_VECTORS),E=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),P=i.getParameter(i.MAX_SAMPLES),R=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:a,textureTypeReadable:o,precision:c,logarithmicDepthBuffer:u,reversedDepthBuffer:d,maxTextures:f,maxVertexTextures:g,maxTextureSize:b,maxCubemapSize:p,maxAttributes:m,maxVertexUniforms:S,maxVaryings:C,maxFragmentUniforms:E,maxSamples:P,samples:R}}function V0(i){let e=this,t=null,n=0,s=!1,r=!1,a=new sn,o=new ke,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(d,u){let f=d.length!==0||u||n!==0||s;return s=u,n=d.length,f},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(d,u){t=h(d,u,0)},this.setState=function(d,u,f){let g=d.clippingPlanes,b=d.clipIntersection,p=d.clipShadows,m=i.get(d);if(!s||g===null||g.length===0||r&&!p)r?h(null):c();else{let S=r?0:n,C=S*4,E=m.clippingState||null;l.value=E,E=h(g,u,C,f);for(let P=0;P!==C;++P)E[P]=t[P];m.clippingState=E,this.numIntersection=b?this.numPlanes:0,this.numPlanes+=S}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=n>0),e.numPlanes=n,e.numIntersection=0}function h(d,u,f,g){let b=d!==null?d.length:0,p=null;if(b!==0){if(p=l.value,g!==!0||p===null){let m=f+b*4,S=u.matrixWorldInverse;o.getNormalMatrix(S),(p===null||p.length<m)&&(p=new Float32Array(m));for(let C=0,E=f;C!==b;++C,E+=4)a.copy(d[C]).applyMatrix4(S,o),a.normal.toArray(p,E),p[E+3]=a.constant}l.value=p,l.needsUpdate=!0}return e.numPlanes=b,e.numIntersection=0,p}}var Sr=class extends on{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},s=[n,n,n,n,n,n];this.texture=new nr(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new vs(5,5,5),r=new Nn({name:"CubemapFromEquirect",uniforms:Wi(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:qt,blending:zi});r.uniforms.tEquirect.value=t;let a=new Gt(s,r),o=t.minFilter;return t.minFilter===ni&&(t.minFilter=Et),new Ms(1,10,this).update(e,a),t.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,s=!0){let r=e.getRenderTarget();for(let a=0;a<6;a++)e.setRenderTarget(this,a),e.clear(t,n,s);e.setRenderTarget(r)}},Ju=256,H0=3,W0=20,vd=256,bd=16,X0=3,q0=new k,Y0=new Ve,Ps=class i{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new Ms(1,10,null),this._boxMesh=new Gt(new vs(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,s=100,r={}){let{size:a=256,position:o=q0}=r,l=this._renderer;this._setSize(a);let c=this._allocateTarget(),h=this._getSourceTarget(!0);t>0&&(h.texture.mipmapsAutoUpdate=!1);let d=l.autoClear,u=l.autoClearColor,f=l.autoClearDepth,g=l.autoClearStencil,b=e.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,b===null&&(e.background=l.getClearColor(Y0));let p=new Ms(n,s,h);return p.position.copy(o),p.update(l,e),l.autoClear=d,l.autoClearColor=u,l.autoClearDepth=f,l.autoClearStencil=g,e.background=b,t>0&&(h.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=ed(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Qu(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(Ju,gc(e))}_fromTexture(e,t){e.mapping===Vi||e.mapping===Es?this._setSize(e.image.length===0?Ju:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=ju(e,!1,!1),n=Math.log2(e)-H0;for(let s=0;s<=n;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=ju(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let s=this._boxMesh,r=this._cubeCamera;s.material=n,r.renderTarget=e,r.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),r.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===Vi||e.mapping===Es?(this._cubemapMaterial===null&&(this._cubemapMaterial=ed()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Qu()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=$0(),this._integrationMaterial=Z0());let t=this._cubeSize,n=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(t/bd);for(let a=0;a<=n;a++){let o=i.lodToRoughness(a,n);if(a>n-X0)r.roughness.value=o,this._renderCube(e,a,this._integrationMaterial);else{let l=o>0?Math.log2(t)+.5*Math.log2(6/(vd*Math.pow(o,4)))+.5:0;s.roughness.value=o,s.lodBias.value=l,this._renderCube(e,a,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=K0());let n=this._blurMaterial,s=n.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(e,0,n),s.envMap.value=e.texture,this._renderCube(r,0,n)}};function ju(i,e,t){return new Sr(i,{minFilter:ni,generateMipmaps:e,type:hn,colorSpace:Ys,depthBuffer:t})}function wr(i,e,t){return new Nn({name:i,uniforms:e,vertexShader:We.cube_vert,fragmentShader:t,side:qt,blending:zi,depthTest:!1,depthWrite:!1})}function $0(){return wr("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${vd}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Z0(){return wr("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:bd}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function K0(){return wr("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${W0}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function Qu(){return wr("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function ed(){return wr("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function J0(i){let e=new WeakMap,t=new WeakMap,n=null;function s(u,f=!1){return u==null?null:f?a(u):r(u)}function r(u){if(u&&u.isTexture){let f=u.mapping;if(f===As||f===Ya)if(e.has(u)){let g=e.get(u).texture;return o(g,u.mapping)}else{let g=u.image;if(g&&g.height>0){let b=new Sr(g.height);return b.fromEquirectangularTexture(i,u),e.set(u,b),u.addEventListener("dispose",c),o(b.texture,u.mapping)}else return null}}return u}function a(u){if(u&&u.isTexture&&u.isPMREMTexture!==!0){let f=u.mapping,g=f===As||f===Ya,b=f===Vi||f===Es;if(g||b){let p=t.get(u),m=p!==void 0?p.texture.pmremVersion:0;if(u.isRenderTargetTexture&&u.pmremVersion!==m)return n===null&&(n=new Ps(i)),p=g?n.fromEquirectangular(u,p):n.fromCubemap(u,p),p.texture.pmremVersion=u.pmremVersion,t.set(u,p),p.texture;if(p!==void 0)return p.texture;{let S=u.image;return g&&S&&S.height>0||b&&S&&l(S)?(n===null&&(n=new Ps(i)),p=g?n.fromEquirectangular(u):n.fromCubemap(u),p.texture.pmremVersion=u.pmremVersion,t.set(u,p),u.addEventListener("dispose",h),p.texture):null}}}return u}function o(u,f){return f===As?u.mapping=Vi:f===Ya&&(u.mapping=Es),u}function l(u){let f=0,g=6;for(let b=0;b<g;b++)u[b]!==void 0&&f++;return f===g}function c(u){let f=u.target;f.removeEventListener("dispose",c);let g=e.get(f);g!==void 0&&(e.delete(f),g.dispose())}function h(u){let f=u.target;f.removeEventListener("dispose",h);let g=t.get(f);g!==void 0&&(t.delete(f),g.dispose())}function d(){e=new WeakMap,t=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:d}}function j0(i){let e={};function t(n){if(e[n]!==void 0)return e[n];let s=i.getExtension(n);return e[n]=s,s}return{has:function(n){return t(n)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(n){let s=t(n);return s===null&&Hs("WebGLRenderer: "+n+" extension not supported."),s}}}function Q0(i,e,t,n){let s={},r=new WeakMap,a=new FinalizationRegistry(g=>delete s[g]);function o(g){l(g.target)}function l(g){g.index!==null&&e.remove(g.index);for(let p in g.attributes)e.remove(g.attributes[p]);g.removeEventListener("dispose",o),delete s[g.id],a.unregister(g);let b=r.get(g);b&&(e.remove(b),r.delete(g)),n.releaseStatesOfGeometry(g),g.isInstancedBufferGeometry===!0&&delete g._maxInstanceCount,t.memory.geometries--}function c(g,b){return s[b.id]!==void 0||(b.addEventListener("dispose",o),s[b.id]=new WeakRef(b),a.register(b,b.id,b),t.memory.geometries++),b}function h(g){let b=g.attributes;for(let p in b)e.update(b[p],i.ARRAY_BUFFER)}function d(g){let b=g.index,p=g.attributes.position,m=0;if(p===void 0)return;let S=b!==null?b.array.length:p.array.length/3-1,C=p.count>=65535?tr:er,E=new C(Math.ceil(S/3)*6,1),P=E.array;if(b!==null){let _=b.array;m=b.version;for(let w=0,H=0;w<S;w+=3){let O=_[w+0],z=_[w+1],$=_[w+2];P[H++]=O,P[H++]=z,P[H++]=z,P[H++]=$,P[H++]=$,P[H++]=O}}else{m=p.version;for(let _=0,w=0;_<S;_+=3){let H=_+0,O=_+1,z=_+2;P[w++]=H,P[w++]=O,P[w++]=O,P[w++]=z,P[w++]=z,P[w++]=H}}E.version=m;let R=r.get(g);R&&e.remove(R),r.set(g,E)}function u(g){let b=r.get(g);if(b){let p=g.index;p!==null&&b.version<p.version&&d(g)}else d(g);return r.get(g)}function f(){for(let g in s){let b=s[g].deref();b!==void 0&&l(b)}}return{get:c,update:h,getWireframeAttribute:u,dispose:f}}function ey(i,e,t){let n;function s(d){n=d}let r,a;function o(d){r=d.type,a=d.bytesPerElement}function l(d,u){i.drawElements(n,u,r,d*a),t.update(u,n,1)}function c(d,u,f){f!==0&&(i.drawElementsInstanced(n,u,r,d*a,f),t.update(u,n,f))}function h(d,u,f){if(f===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,u,0,r,d,0,f);let b=0;for(let p=0;p<f;p++)b+=u[p];t.update(b,n,1)}this.setMode=s,this.setIndex=o,this.render=l,this.renderInstances=c,this.renderMultiDraw=h}function ty(i){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,a,o){switch(t.calls++,a){case i.TRIANGLES:t.triangles+=o*(r/3);break;case i.LINES:t.lines+=o*(r/2);break;case i.LINE_STRIP:t.lines+=o*(r-1);break;case i.LINE_LOOP:t.lines+=o*r;break;case i.POINTS:t.points+=o*r;break;default:Fe("WebGLInfo: Unknown draw mode:",a);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:n}}function ny(i,e,t){let n=new WeakMap,s=new mt;function r(a,o,l){let c=a.morphTargetInfluences,h=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,d=h!==void 0?h.length:0,u=n.get(o);if(u===void 0||u.count!==d){let H=function(){_.dispose(),n.delete(o),o.removeEventListener("dispose",H)};u!==void 0&&u.texture.dispose();let f=o.morphAttributes.position!==void 0,g=o.morphAttributes.normal!==void 0,b=o.morphAttributes.color!==void 0,p=o.morphAttributes.position||[],m=o.morphAttributes.normal||[],S=o.morphAttributes.color||[],C=0;f===!0&&(C=1),g===!0&&(C=2),b===!0&&(C=3);let E=o.attributes.position.count*C,P=1;E>e.maxTextureSize&&(P=Math.ceil(E/e.maxTextureSize),E=e.maxTextureSize);let R=new Float32Array(E*P*4*d),_=new Ks(R,E,P,d);_.type=Mn,_.needsUpdate=!0;let w=C*4;for(let O=0;O<d;O++){let z=p[O],$=m[O],te=S[O],U=E*P*4*O;for(let j=0;j<z.count;j++){let ie=j*w;f===!0&&(s.fromBufferAttribute(z,j),R[U+ie+0]=s.x,R[U+ie+1]=s.y,R[U+ie+2]=s.z,R[U+ie+3]=0),g===!0&&(s.fromBufferAttribute($,j),R[U+ie+4]=s.x,R[U+ie+5]=s.y,R[U+ie+6]=s.z,R[U+ie+7]=0),b===!0&&(s.fromBufferAttribute(te,j),R[U+ie+8]=s.x,R[U+ie+9]=s.y,R[U+ie+10]=s.z,R[U+ie+11]=te.itemSize===4?s.w:1)}}u={count:d,texture:_,size:new Oe(E,P)},n.set(o,u),o.addEventListener("dispose",H)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",a.morphTexture,t);else{let f=0;for(let b=0;b<c.length;b++)f+=c[b];let g=o.morphTargetsRelative?1:1-f;l.getUniforms().setValue(i,"morphTargetBaseInfluence",g),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",u.texture,t),l.getUniforms().setValue(i,"morphTargetsTextureSize",u.size)}return{update:r}}function iy(i,e,t,n,s){let r=new WeakMap;function a(c){let h=s.render.frame,d=c.geometry,u=e.get(c,d);if(r.get(u)!==h&&(e.update(u),r.set(u,h)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==h&&(t.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&t.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,h))),c.isSkinnedMesh){let f=c.skeleton;r.get(f)!==h&&(f.update(),r.set(f,h))}return u}function o(){r=new WeakMap}function l(c){let h=c.target;h.removeEventListener("dispose",l),n.releaseStatesOfObject(h),t.remove(h.instanceMatrix),h.instanceColor!==null&&t.remove(h.instanceColor)}return{update:a,dispose:o}}var sy={[Kl]:"LINEAR_TONE_MAPPING",[Jl]:"REINHARD_TONE_MAPPING",[jl]:"CINEON_TONE_MAPPING",[Ql]:"ACES_FILMIC_TONE_MAPPING",[tc]:"AGX_TONE_MAPPING",[fr]:"NEUTRAL_TONE_MAPPING",[ec]:"CUSTOM_TONE_MAPPING"};function ry(i,e,t,n,s,r){let a=new on(e,t,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),o=null,l=null,c=null,h=new Dn;h.setAttribute("position",new pn([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new pn([0,2,0,0,2,0],2));let d=new La({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),u=new Gt(h,d),f=new lr(-1,1,1,-1,0,1),g=null,b=null,p=!1,m,S=null,C=[],E=!1;this.setSize=function(P,R){a.setSize(P,R),o!==null&&o.setSize(P,R),l!==null&&l.setSize(P,R);for(let _=0;_<C.length;_++){let w=C[_];w.setSize&&w.setSize(P,R)}},this.setEffects=function(P){C=P,E=C.length>0&&C[0].isRenderPass===!0;let R=a.width,_=a.height;C.length>0&&o===null&&(o=new on(R,_,{type:hn,depthBuffer:!1,stencilBuffer:!1}),l=new on(R,_,{type:hn,depthBuffer:!1,stencilBuffer:!1}));let w=s===!0&&C.some(H=>H.needsDepthTexture===!0);w!==(a.depthTexture!==null)&&(w===!0&&c===null&&(c=new ti(R,_),r===!0&&(c.format=ii,c.type=Hi)),a.dispose(),a.depthTexture=w?c:null,a.resolveDepthBuffer=w,a.storeMultisampledDepthBuffer=w);for(let H=0;H<C.length;H++){let O=C[H];O.setSize&&O.setSize(R,_),w&&O.needsDepthTexture===!0&&O.setDepthTexture&&O.setDepthTexture(c)}},this.begin=function(P,R){if(p||P.toneMapping===On&&C.length===0)return!1;if(S=R,R!==null){let _=R.width,w=R.height;(a.width!==_||a.height!==w)&&this.setSize(_,w)}return E===!1&&P.setRenderTarget(a),m=P.toneMapping,P.toneMapping=On,!0},this.hasRenderPass=function(){return E},this.end=function(P,R){P.toneMapping=m,p=!0;let _=a,w=o;for(let H=0;H<C.length;H++){let O=C[H];O.enabled!==!1&&(O.render(P,w,_,R),O.needsSwap!==!1&&(_=w,w=w===o?l:o))}if(g!==P.outputColorSpace||b!==P.toneMapping){g=P.outputColorSpace,b=P.toneMapping,d.defines={},Ze.getTransfer(g)===it&&(d.defines.SRGB_TRANSFER="");let H=sy[b];H&&(d.defines[H]=""),d.needsUpdate=!0}d.uniforms.tDiffuse.value=_.texture,P.setRenderTarget(S),P.render(u,f),S=null,p=!1},this.isCompositing=function(){return p},this.dispose=function(){a.dispose(),o!==null&&o.dispose(),l!==null&&l.dispose(),h.dispose(),d.dispose()}}var Md=new zt,Sd=new ti(1,1),wd=new ir(1),Ed=new Ks,Ad=new Pa,Td=new nr,td=[],nd=[],id=new Float32Array(16),sd=new Float32Array(9),rd=new Float32Array(4);function Is(i,e,t){let n=i[0];if(n<=0||n>0)return i;let s=e*t,r=td[s];if(r===void 0&&(r=new Float32Array(s),td[s]=r),e!==0){n.toArray(r,0);for(let a=1,o=0;a!==e;++a)o+=t,i[a].toArray(r,o)}return r}function Tt(i,e){if(i.length!==e.length)return!1;for(let t=0,n=i.length;t<n;t++)if(i[t]!==e[t])return!1;return!0}function Rt(i,e){for(let t=0,n=e.length;t<n;t++)i[t]=e[t]}function Fo(i,e){let t=nd[e];t===void 0&&(t=new Int32Array(e),nd[e]=t);for(let n=0;n!==e;++n)t[n]=i.allocateTextureUnit();return t}function ay(i,e){let t=this.cache;t[0]!==e&&(i.uniform1f(this.addr,e),t[0]=e)}function oy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Tt(t,e))return;i.uniform2fv(this.addr,e),Rt(t,e)}}function ly(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(i.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(Tt(t,e))return;i.uniform3fv(this.addr,e),Rt(t,e)}}function cy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Tt(t,e))return;i.uniform4fv(this.addr,e),Rt(t,e)}}function hy(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(Tt(t,e))return;i.uniformMatrix2fv(this.addr,!1,e),Rt(t,e)}else{if(Tt(t,n))return;rd.set(n),i.uniformMatrix2fv(this.addr,!1,rd),Rt(t,n)}}function uy(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(Tt(t,e))return;i.uniformMatrix3fv(this.addr,!1,e),Rt(t,e)}else{if(Tt(t,n))return;sd.set(n),i.uniformMatrix3fv(this.addr,!1,sd),Rt(t,n)}}function dy(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(Tt(t,e))return;i.uniformMatrix4fv(this.addr,!1,e),Rt(t,e)}else{if(Tt(t,n))return;id.set(n),i.uniformMatrix4fv(this.addr,!1,id),Rt(t,n)}}function fy(i,e){let t=this.cache;t[0]!==e&&(i.uniform1i(this.addr,e),t[0]=e)}function py(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Tt(t,e))return;i.uniform2iv(this.addr,e),Rt(t,e)}}function my(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Tt(t,e))return;i.uniform3iv(this.addr,e),Rt(t,e)}}function gy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Tt(t,e))return;i.uniform4iv(this.addr,e),Rt(t,e)}}function yy(i,e){let t=this.cache;t[0]!==e&&(i.uniform1ui(this.addr,e),t[0]=e)}function _y(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Tt(t,e))return;i.uniform2uiv(this.addr,e),Rt(t,e)}}function xy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Tt(t,e))return;i.uniform3uiv(this.addr,e),Rt(t,e)}}function vy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Tt(t,e))return;i.uniform4uiv(this.addr,e),Rt(t,e)}}function Oo(i){return i.version===0&&(i.compareFunction=dc,i.needsUpdate=!0),i}function by(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=Oo(Sd):r=Md,t.setTexture2D(e||r,s)}function My(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture3D(e||Ad,s)}function Sy(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=Oo(wd):r=Td,t.setTextureCube(e||r,s)}function wy(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture2DArray(e||Ed,s)}function Ey(i){switch(i){case 5126:return ay;case 35664:return oy;case 35665:return ly;case 35666:return cy;case 35674:return hy;case 35675:return uy;case 35676:return dy;case 5124:case 35670:return fy;case 35667:case 35671:return py;case 35668:case 35672:return my;case 35669:case 35673:return gy;case 5125:return yy;case 36294:return _y;case 36295:return xy;case 36296:return vy;case 35678:case 36198:case 36298:case 36306:case 35682:return by;case 35679:case 36299:case 36307:return My;case 35680:case 36300:case 36308:case 36293:return Sy;case 36289:case 36303:case 36311:case 36292:return wy}}function Ay(i,e){i.uniform1fv(this.addr,e)}function Ty(i,e){let t=Is(e,this.size,2);i.uniform2fv(this.addr,t)}function Ry(i,e){let t=Is(e,this.size,3);i.uniform3fv(this.addr,t)}function Cy(i,e){let t=Is(e,this.size,4);i.uniform4fv(this.addr,t)}function Py(i,e){let t=Is(e,this.size,4);i.uniformMatrix2fv(this.addr,!1,t)}function Iy(i,e){let t=Is(e,this.size,9);i.uniformMatrix3fv(this.addr,!1,t)}function Ly(i,e){let t=Is(e,this.size,16);i.uniformMatrix4fv(this.addr,!1,t)}function Dy(i,e){i.uniform1iv(this.addr,e)}function Ny(i,e){i.uniform2iv(this.addr,e)}function Uy(i,e){i.uniform3iv(this.addr,e)}function Fy(i,e){i.uniform4iv(this.addr,e)}function Oy(i,e){i.uniform1uiv(this.addr,e)}function By(i,e){i.uniform2uiv(this.addr,e)}function ky(i,e){i.uniform3uiv(this.addr,e)}function zy(i,e){i.uniform4uiv(this.addr,e)}function Gy(i,e,t){let n=this.cache,s=e.length,r=Fo(t,s);Tt(n,r)||(i.uniform1iv(this.addr,r),Rt(n,r));let a;this.type===i.SAMPLER_2D_SHADOW?a=Oo(Sd):a=Md;for(let o=0;o!==s;++o)t.setTexture2D(e[o]||a,r[o])}function Vy(i,e,t){let n=this.cache,s=e.length,r=Fo(t,s);Tt(n,r)||(i.uniform1iv(this.addr,r),Rt(n,r));for(let a=0;a!==s;++a)t.setTexture3D(e[a]||Ad,r[a])}function Hy(i,e,t){let n=this.cache,s=e.length,r=Fo(t,s);Tt(n,r)||(i.uniform1iv(this.addr,r),Rt(n,r));let a;this.type===i.SAMPLER_CUBE_SHADOW?a=Oo(wd):a=Td;for(let o=0;o!==s;++o)t.setTextureCube(e[o]||a,r[o])}function Wy(i,e,t){let n=this.cache,s=e.length,r=Fo(t,s);Tt(n,r)||(i.uniform1iv(this.addr,r),Rt(n,r));for(let a=0;a!==s;++a)t.setTexture2DArray(e[a]||Ed,r[a])}function Xy(i){switch(i){case 5126:return Ay;case 35664:return Ty;case 35665:return Ry;case 35666:return Cy;case 35674:return Py;case 35675:return Iy;case 35676:return Ly;case 5124:case 35670:return Dy;case 35667:case 35671:return Ny;case 35668:case 35672:return Uy;case 35669:case 35673:return Fy;case 5125:return Oy;case 36294:return By;case 36295:return ky;case 36296:return zy;case 35678:case 36198:case 36298:case 36306:case 35682:return Gy;case 35679:case 36299:case 36307:return Vy;case 35680:case 36300:case 36308:case 36293:return Hy;case 36289:case 36303:case 36311:case 36292:return Wy}}var wc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=Ey(t.type)}},Ec=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Xy(t.type)}},Ac=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let s=this.seq;for(let r=0,a=s.length;r!==a;++r){let o=s[r];o.setValue(e,t[o.id],n)}}},Mc=/(\w+)(\])?(\[|\.)?/g;function ad(i,e){i.seq.push(e),i.map[e.id]=e}function qy(i,e,t){let n=i.name,s=n.length;for(Mc.lastIndex=0;;){let r=Mc.exec(n),a=Mc.lastIndex,o=r[1],l=r[2]==="]",c=r[3];if(l&&(o=o|0),c===void 0||c==="["&&a+2===s){ad(t,c===void 0?new wc(o,i,e):new Ec(o,i,e));break}else{let d=t.map[o];d===void 0&&(d=new Ac(o),ad(t,d)),t=d}}}var Cs=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let a=0;a<n;++a){let o=e.getActiveUniform(t,a),l=e.getUniformLocation(t,o.name);qy(o,l,this)}let s=[],r=[];for(let a of this.seq)a.type===e.SAMPLER_2D_SHADOW||a.type===e.SAMPLER_CUBE_SHADOW||a.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(a):r.push(a);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,n,s){let r=this.map[t];r!==void 0&&r.setValue(e,n,s)}setOptional(e,t,n){let s=t[n];s!==void 0&&this.setValue(e,n,s)}static upload(e,t,n,s){for(let r=0,a=t.length;r!==a;++r){let o=t[r],l=n[o.id];l.needsUpdate!==!1&&o.setValue(e,l.value,s)}}static seqWithValue(e,t){let n=[];for(let s=0,r=e.length;s!==r;++s){let a=e[s];a.id in t&&n.push(a)}return n}};function od(i,e,t){let n=i.createShader(e);return i.shaderSource(n,t),i.compileShader(n),n}var Yy=37297,$y=0;function Zy(i,e){let t=i.split(`
`),n=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let a=s;a<r;a++){let o=a+1;n.push(`${o===e?">":" "} ${o}: ${t[a]}`)}return n.join(`
`)}var ld=new ke;function Ky(i){Ze._getMatrix(ld,Ze.workingColorSpace,i);let e=`mat3( ${ld.elements.map(t=>t.toFixed(4))} )`;switch(Ze.getTransfer(i)){case $s:return[e,"LinearTransferOETF"];case it:return[e,"sRGBTransferOETF"];default:return De("WebGLProgram: Unsupported color space: ",i),[e,"LinearTransferOETF"]}}function cd(i,e,t){let n=i.getShaderParameter(e,i.COMPILE_STATUS),r=(i.getShaderInfoLog(e)||"").trim();if(n&&r==="")return"";let a=/ERROR: 0:(\d+)/.exec(r);if(a){let o=parseInt(a[1]);return t.toUpperCase()+`

`+r+`

`+Zy(i.getShaderSource(e),o)}else return r}function Jy(i,e){let t=Ky(e);return[`vec4 ${i}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var jy={[Kl]:"Linear",[Jl]:"Reinhard",[jl]:"Cineon",[Ql]:"ACESFilmic",[tc]:"AgX",[fr]:"Neutral",[ec]:"Custom"};function Qy(i,e){let t=jy[e];return t===void 0?(De("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var No=new k;function e_(){Ze.getLuminanceCoefficients(No);let i=No.x.toFixed(4),e=No.y.toFixed(4),t=No.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function t_(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Mr).join(`
`)}function n_(i){let e=[];for(let t in i){let n=i[t];n!==!1&&e.push("#define "+t+" "+n)}return e.join(`
`)}function i_(i,e){let t={},n=i.getProgramParameter(e,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(e,s),a=r.name,o=1;r.type===i.FLOAT_MAT2&&(o=2),r.type===i.FLOAT_MAT3&&(o=3),r.type===i.FLOAT_MAT4&&(o=4),t[a]={type:r.type,location:i.getAttribLocation(e,a),locationSize:o}}return t}function Mr(i){return i!==""}function hd(i,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function ud(i,e){return i.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var s_=/^[ \t]*#include +<([\w\d./]+)>/gm;function Tc(i){return i.replace(s_,r_)}function r_(i,e){let t=We[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Tc(t)}var a_=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function dd(i){return i.replace(a_,o_)}function o_(i,e,t,n){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function fd(i){let e=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?e+=`
#define HIGH_PRECISION`:i.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var l_={[dr]:"SHADOWMAP_TYPE_PCF",[Ss]:"SHADOWMAP_TYPE_VSM"};function c_(i){return l_[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var h_={[Es]:"ENVMAP_MODE_REFRACTION"};function u_(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":h_[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var d_={[Zl]:"ENVMAP_BLENDING_MULTIPLY",[Cu]:"ENVMAP_BLENDING_MIX",[Pu]:"ENVMAP_BLENDING_ADD"};function f_(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":d_[i.combine]||"ENVMAP_BLENDING_NONE"}function p_(i,e,t,n){let s=i.getContext(),r=t.defines,a=t.vertexShader,o=t.fragmentShader,l=c_(t),c=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=u_(t),d=f_(t),u=t_(t),f=n_(r),g=s.createProgram(),b,p,m=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(b=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Mr).join(`
`),b.length>0&&(b+=`
`),p=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Mr).join(`
`),p.length>0&&(p+=`
`)):(b=[fd(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+h:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Mr).join(`
`),p=[fd(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+h:"",t.envMap?"#define "+d:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==On?"#define TONE_MAPPING":"",t.toneMapping!==On?We.tonemapping_pars_fragment:"",t.toneMapping!==On?Qy("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",We.colorspace_pars_fragment,Jy("linearToOutputTexel",t.outputColorSpace),e_(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(Mr).join(`
`)),a=Tc(a),a=hd(a,t),a=ud(a,t),o=Tc(o),o=hd(o,t),o=ud(o,t),a=dd(a),o=dd(o),t.isRawShaderMaterial!==!0&&(m=`#version 300 es
`,b=[u,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+b,p=["#define varying in",t.glslVersion===fc?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===fc?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+p);let S=m+b+a,C=m+p+o,E=od(s,s.VERTEX_SHADER,S),P=od(s,s.FRAGMENT_SHADER,C);s.attachShader(g,E),s.attachShader(g,P),t.index0AttributeName!==void 0?s.bindAttribLocation(g,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(g,0,"position"),s.linkProgram(g);function R(O){if(i.debug.checkShaderErrors){let z=s.getProgramInfoLog(g)||"",$=s.getShaderInfoLog(E)||"",te=s.getShaderInfoLog(P)||"",U=z.trim(),j=$.trim(),ie=te.trim(),Z=!0,he=!0;if(s.getProgramParameter(g,s.LINK_STATUS)===!1)if(Z=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,g,E,P);else{let K=cd(s,E,"vertex"),oe=cd(s,P,"fragment");Fe("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(g,s.VALIDATE_STATUS)+`

Material Name: `+O.name+`
Material Type: `+O.type+`

Program Info Log: `+U+`
`+K+`
`+oe)}else U!==""?De("WebGLProgram: Program Info Log:",U):(j===""||ie==="")&&(he=!1);he&&(O.diagnostics={runnable:Z,programLog:U,vertexShader:{log:j,prefix:b},fragmentShader:{log:ie,prefix:p}})}s.deleteShader(E),s.deleteShader(P),_=new Cs(s,g),w=i_(s,g)}let _;this.getUniforms=function(){return _===void 0&&R(this),_};let w;this.getAttributes=function(){return w===void 0&&R(this),w};let H=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return H===!1&&(H=s.getProgramParameter(g,Yy)),H},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(g),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=$y++,this.cacheKey=e,this.usedTimes=1,this.program=g,this.vertexShader=E,this.fragmentShader=P,this}var m_=0,Rc=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let n of t)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new Cc(e),t.set(e,n)),n}},Cc=class{constructor(e){this.id=m_++,this.code=e,this.usedTimes=0}};function g_(i){return i===bi||i===xr||i===vr}function y_(i,e,t,n,s,r){let a=new Js,o=new Rc,l=new Set,c=[],h=new Map,d=n.logarithmicDepthBuffer,u={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(_){return l.add(_),_===0?"uv":`uv${_}`}function g(_,w,H,O,z,$){let te=O.fog,U=z.geometry,j=_.isMeshStandardMaterial||_.isMeshLambertMaterial||_.isMeshPhongMaterial?O.environment:null,ie=_.isMeshStandardMaterial||_.isMeshLambertMaterial&&!_.envMap||_.isMeshPhongMaterial&&!_.envMap,Z=e.get(_.envMap||j,ie),he=u[_.type],K=n.precision;_.precision!==null&&(K=n.getMaxPrecision(_.precision),K!==_.precision&&De("WebGLProgram.getParameters:",_.precision,"not supported, using",K,"instead."));let oe=U.morphAttributes.position||U.morphAttributes.normal||U.morphAttributes.color,le=oe!==void 0?oe.length:0,Re=0;U.morphAttributes.position!==void 0&&(Re=1),U.morphAttributes.normal!==void 0&&(Re=2),U.morphAttributes.color!==void 0&&(Re=3);let Ne,se,ye,Se;if(he){let X=kn[he];Ne=X.vertexShader,se=X.fragmentShader}else{Ne=_.vertexShader,se=_.fragmentShader;let X=o.getVertexShaderStage(_),be=o.getFragmentShaderStage(_);o.update(_,X,be),ye=X.id,Se=be.id}let Le=i.getRenderTarget(),_e=i.state.buffers.depth.getReversed(),Be=z.isInstancedMesh===!0,ot=z.isBatchedMesh===!0,Pe=!!_.map,Ke=!!_.matcap,Qe=!!Z,qe=Qe&&Z.isPMREMTexture===!0,At=!!_.aoMap,yt=!!_.lightMap,bt=!!_.bumpMap&&_.wireframe===!1,ut=!!_.normalMap,un=!!_.displacementMap,Mt=!!_.emissiveMap,Yt=!!_.metalnessMap,$t=!!_.roughnessMap,Zt=_.anisotropy>0,B=_.clearcoat>0,Kt=_.diffuseRoughness>0,rt=_.dispersion>0,lt=_.retroreflectivity>0,ge=_.iridescence>0,xt=_.sheen>0,Ie=_.transmission>0,Ue=Zt&&!!_.anisotropyMap,A=B&&!!_.clearcoatMap,x=B&&!!_.clearcoatNormalMap,G=B&&!!_.clearcoatRoughnessMap,ce=Kt&&!!_.diffuseRoughnessMap,ae=ge&&!!_.iridescenceMap,ue=ge&&!!_.iridescenceThicknessMap,de=xt&&!!_.sheenColorMap,ee=xt&&!!_.sheenRoughnessMap,ne=!!_.specularMap,fe=!!_.specularColorMap,I=!!_.specularIntensityMap,re=Ie&&!!_.transmissionMap,J=Ie&&!!_.thicknessMap,y=!!_.gradientMap,M=!!_.alphaMap,T=_.alphaTest>0,F=!!_.alphaHash,D=!!_.extensions,L=On;_.toneMapped&&(Le===null||Le.isXRRenderTarget===!0)&&(L=i.toneMapping);let q=qe?Z.isCompressedCubeTexture?Z.image[0].mipmaps:Z.mipmaps:null,Q={shaderID:he,shaderType:_.type,shaderName:_.name,vertexShader:Ne,fragmentShader:se,defines:_.defines,customVertexShaderID:ye,customFragmentShaderID:Se,isRawShaderMaterial:_.isRawShaderMaterial===!0,glslVersion:_.glslVersion,precision:K,batching:ot,batchingColor:ot&&z._colorsTexture!==null,instancing:Be,instancingColor:Be&&z.instanceColor!==null,instancingMorph:Be&&z.morphTexture!==null,outputColorSpace:Le===null?i.outputColorSpace:Le.isXRRenderTarget===!0?Le.texture.colorSpace:Ze.workingColorSpace,alphaToCoverage:!!_.alphaToCoverage,map:Pe,matcap:Ke,envMap:Qe,envMapMode:Qe&&Z.mapping,envMapPMREM:qe,envMapMaxLod:qe?q.length-1:null,envMapSize:qe?q[0].width:null,aoMap:At,lightMap:yt,bumpMap:bt,normalMap:ut,displacementMap:un,emissiveMap:Mt,normalMapObjectSpace:ut&&_.normalMapType===Du,normalMapTangentSpace:ut&&_.normalMapType===Lo,packedNormalMap:ut&&_.normalMapType===Lo&&g_(_.normalMap.format),metalnessMap:Yt,roughnessMap:$t,anisotropy:Zt,anisotropyMap:Ue,clearcoat:B,clearcoatMap:A,clearcoatNormalMap:x,clearcoatRoughnessMap:G,diffuseRoughness:Kt,diffuseRoughnessMap:ce,dispersion:rt,retroreflection:lt,iridescence:ge,iridescenceMap:ae,iridescenceThicknessMap:ue,sheen:xt,sheenColorMap:de,sheenRoughnessMap:ee,specularMap:ne,specularColorMap:fe,specularIntensityMap:I,transmission:Ie,transmissionMap:re,thicknessMap:J,gradientMap:y,opaque:_.transparent===!1&&_.blending===ws&&_.alphaToCoverage===!1,alphaMap:M,alphaTest:T,alphaHash:F,combine:_.combine,mapUv:Pe&&f(_.map.channel),aoMapUv:At&&f(_.aoMap.channel),lightMapUv:yt&&f(_.lightMap.channel),bumpMapUv:bt&&f(_.bumpMap.channel),normalMapUv:ut&&f(_.normalMap.channel),displacementMapUv:un&&f(_.displacementMap.channel),emissiveMapUv:Mt&&f(_.emissiveMap.channel),metalnessMapUv:Yt&&f(_.metalnessMap.channel),roughnessMapUv:$t&&f(_.roughnessMap.channel),anisotropyMapUv:Ue&&f(_.anisotropyMap.channel),clearcoatMapUv:A&&f(_.clearcoatMap.channel),clearcoatNormalMapUv:x&&f(_.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:G&&f(_.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:ce&&f(_.diffuseRoughnessMap.channel),iridescenceMapUv:ae&&f(_.iridescenceMap.channel),iridescenceThicknessMapUv:ue&&f(_.iridescenceThicknessMap.channel),sheenColorMapUv:de&&f(_.sheenColorMap.channel),sheenRoughnessMapUv:ee&&f(_.sheenRoughnessMap.channel),specularMapUv:ne&&f(_.specularMap.channel),specularColorMapUv:fe&&f(_.specularColorMap.channel),specularIntensityMapUv:I&&f(_.specularIntensityMap.channel),transmissionMapUv:re&&f(_.transmissionMap.channel),thicknessMapUv:J&&f(_.thicknessMap.channel),alphaMapUv:M&&f(_.alphaMap.channel),vertexTangents:!!U.attributes.tangent&&(ut||Zt),vertexNormals:!!U.attributes.normal,vertexColors:_.vertexColors,vertexAlphas:_.vertexColors===!0&&!!U.attributes.color&&U.attributes.color.itemSize===4,pointsUvs:z.isPoints===!0&&!!U.attributes.uv&&(Pe||M),fog:!!te,useFog:_.fog===!0,fogExp2:!!te&&te.isFogExp2,flatShading:_.wireframe===!1&&(_.flatShading===!0||U.attributes.normal===void 0&&ut===!1&&(_.isMeshLambertMaterial||_.isMeshPhongMaterial||_.isMeshStandardMaterial||_.isMeshPhysicalMaterial)),sizeAttenuation:_.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:_e,skinning:z.isSkinnedMesh===!0,hasPositionAttribute:U.attributes.position!==void 0,morphTargets:U.morphAttributes.position!==void 0,morphNormals:U.morphAttributes.normal!==void 0,morphColors:U.morphAttributes.color!==void 0,morphTargetsCount:le,morphTextureStride:Re,numSunLights:w.sun.length,numDirLights:w.directional.length,numPointLights:w.point.length,numSpotLights:w.spot.length,numSpotLightMaps:w.spotLightMap.length,numRectAreaLights:w.rectArea.length,numHemiLights:w.hemi.length,numSunLightShadows:w.sunShadowMap.length,numDirLightShadows:w.directionalShadowMap.length,numPointLightShadows:w.pointShadowMap.length,numSpotLightShadows:w.spotShadowMap.length,numSpotLightShadowsWithMaps:w.numSpotLightShadowsWithMaps,numLightProbes:w.numLightProbes,numLightProbeGrids:$.filter(X=>X.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:_.dithering,shadowMapEnabled:i.shadowMap.enabled&&H.length>0,shadowMapType:i.shadowMap.type,toneMapping:L,decodeVideoTexture:Pe&&_.map.isVideoTexture===!0&&Ze.getTransfer(_.map.colorSpace)===it,decodeVideoTextureEmissive:Mt&&_.emissiveMap.isVideoTexture===!0&&Ze.getTransfer(_.emissiveMap.colorSpace)===it,premultipliedAlpha:_.premultipliedAlpha,doubleSided:_.side===Jt,flipSided:_.side===qt,useDepthPacking:_.depthPacking>=0,depthPacking:_.depthPacking||0,index0AttributeName:_.index0AttributeName,extensionClipCullDistance:D&&_.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(D&&_.extensions.multiDraw===!0||ot)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:_.customProgramCacheKey()};return Q.vertexUv1s=l.has(1),Q.vertexUv2s=l.has(2),Q.vertexUv3s=l.has(3),l.clear(),Q}function b(_){let w=[];if(_.shaderID?w.push(_.shaderID):(w.push(_.customVertexShaderID),w.push(_.customFragmentShaderID)),_.defines!==void 0)for(let H in _.defines)w.push(H),w.push(_.defines[H]);return _.isRawShaderMaterial===!1&&(p(w,_),m(w,_),w.push(i.outputColorSpace)),w.push(_.customProgramCacheKey),w.join()}function p(_,w){_.push(w.precision),_.push(w.outputColorSpace),_.push(w.envMapMode),_.push(w.envMapPMREM),_.push(w.envMapMaxLod),_.push(w.envMapSize),_.push(w.mapUv),_.push(w.alphaMapUv),_.push(w.lightMapUv),_.push(w.aoMapUv),_.push(w.bumpMapUv),_.push(w.normalMapUv),_.push(w.displacementMapUv),_.push(w.emissiveMapUv),_.push(w.metalnessMapUv),_.push(w.roughnessMapUv),_.push(w.anisotropyMapUv),_.push(w.clearcoatMapUv),_.push(w.clearcoatNormalMapUv),_.push(w.clearcoatRoughnessMapUv),_.push(w.diffuseRoughnessMapUv),_.push(w.iridescenceMapUv),_.push(w.iridescenceThicknessMapUv),_.push(w.sheenColorMapUv),_.push(w.sheenRoughnessMapUv),_.push(w.specularMapUv),_.push(w.specularColorMapUv),_.push(w.specularIntensityMapUv),_.push(w.transmissionMapUv),_.push(w.thicknessMapUv),_.push(w.combine),_.push(w.fogExp2),_.push(w.sizeAttenuation),_.push(w.morphTargetsCount),_.push(w.numSunLights),_.push(w.numDirLights),_.push(w.numPointLights),_.push(w.numSpotLights),_.push(w.numSpotLightMaps),_.push(w.numHemiLights),_.push(w.numRectAreaLights),_.push(w.numSunLightShadows),_.push(w.numDirLightShadows),_.push(w.numPointLightShadows),_.push(w.numSpotLightShadows),_.push(w.numSpotLightShadowsWithMaps),_.push(w.numLightProbes),_.push(w.numLightProbeGrids),_.push(w.shadowMapType),_.push(w.toneMapping),_.push(w.numClippingPlanes),_.push(w.numClipIntersection),_.push(w.depthPacking)}function m(_,w){a.disableAll(),w.instancing&&a.enable(0),w.instancingColor&&a.enable(1),w.instancingMorph&&a.enable(2),w.matcap&&a.enable(3),w.envMap&&a.enable(4),w.normalMapObjectSpace&&a.enable(5),w.normalMapTangentSpace&&a.enable(6),w.clearcoat&&a.enable(7),w.iridescence&&a.enable(8),w.alphaTest&&a.enable(9),w.vertexColors&&a.enable(10),w.vertexAlphas&&a.enable(11),w.vertexUv1s&&a.enable(12),w.vertexUv2s&&a.enable(13),w.vertexUv3s&&a.enable(14),w.vertexTangents&&a.enable(15),w.anisotropy&&a.enable(16),w.alphaHash&&a.enable(17),w.batching&&a.enable(18),w.dispersion&&a.enable(19),w.retroreflection&&a.enable(24),w.diffuseRoughness&&a.enable(25),w.batchingColor&&a.enable(20),w.gradientMap&&a.enable(21),w.packedNormalMap&&a.enable(22),w.vertexNormals&&a.enable(23),_.push(a.mask),a.disableAll(),w.fog&&a.enable(0),w.useFog&&a.enable(1),w.flatShading&&a.enable(2),w.logarithmicDepthBuffer&&a.enable(3),w.reversedDepthBuffer&&a.enable(4),w.skinning&&a.enable(5),w.morphTargets&&a.enable(6),w.morphNormals&&a.enable(7),w.morphColors&&a.enable(8),w.premultipliedAlpha&&a.enable(9),w.shadowMapEnabled&&a.enable(10),w.doubleSided&&a.enable(11),w.flipSided&&a.enable(12),w.useDepthPacking&&a.enable(13),w.dithering&&a.enable(14),w.transmission&&a.enable(15),w.sheen&&a.enable(16),w.opaque&&a.enable(17),w.pointsUvs&&a.enable(18),w.decodeVideoTexture&&a.enable(19),w.decodeVideoTextureEmissive&&a.enable(20),w.alphaToCoverage&&a.enable(21),w.numLightProbeGrids>0&&a.enable(22),w.hasPositionAttribute&&a.enable(23),_.push(a.mask)}function S(_){let w=u[_.type],H;if(w){let O=kn[w];H=$u.clone(O.uniforms)}else H=_.uniforms;return H}function C(_,w){let H=h.get(w);return H!==void 0?++H.usedTimes:(H=new p_(i,w,_,s),c.push(H),h.set(w,H)),H}function E(_){if(--_.usedTimes===0){let w=c.indexOf(_);c[w]=c[c.length-1],c.pop(),h.delete(_.cacheKey),_.destroy()}}function P(_){o.remove(_)}function R(){o.dispose()}return{getParameters:g,getProgramCacheKey:b,getUniforms:S,acquireProgram:C,releaseProgram:E,releaseShaderCache:P,programs:c,dispose:R}}function __(){let i=new WeakMap;function e(a){return i.has(a)}function t(a){let o=i.get(a);return o===void 0&&(o={},i.set(a,o)),o}function n(a){i.delete(a)}function s(a,o,l){i.get(a)[o]=l}function r(){i=new WeakMap}return{has:e,get:t,remove:n,update:s,dispose:r}}function x_(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.material.id!==e.material.id?i.material.id-e.material.id:i.materialVariant!==e.materialVariant?i.materialVariant-e.materialVariant:i.z!==e.z?i.z-e.z:i.id-e.id}function pd(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.z!==e.z?e.z-i.z:i.id-e.id}function md(){let i=[],e=0,t=[],n=[],s=[];function r(){e=0,t.length=0,n.length=0,s.length=0}function a(u){let f=0;return u.isInstancedMesh&&(f+=2),u.isSkinnedMesh&&(f+=1),f}function o(u,f,g,b,p,m){let S=i[e];return S===void 0?(S={id:u.id,object:u,geometry:f,material:g,materialVariant:a(u),groupOrder:b,renderOrder:u.renderOrder,z:p,group:m},i[e]=S):(S.id=u.id,S.object=u,S.geometry=f,S.material=g,S.materialVariant=a(u),S.groupOrder=b,S.renderOrder=u.renderOrder,S.z=p,S.group=m),e++,S}function l(u,f,g,b,p,m,S){S.reversedDepth===!0&&(p=-p);let C=o(u,f,g,b,p,m);g.transmission>0?n.push(C):g.transparent===!0?s.push(C):t.push(C)}function c(u,f,g,b,p,m){let S=o(u,f,g,b,p,m);g.transmission>0?n.unshift(S):g.transparent===!0?s.unshift(S):t.unshift(S)}function h(u,f){t.length>1&&t.sort(u||x_),n.length>1&&n.sort(f||pd),s.length>1&&s.sort(f||pd)}function d(){for(let u=e,f=i.length;u<f;u++){let g=i[u];if(g.id===null)break;g.id=null,g.object=null,g.geometry=null,g.material=null,g.group=null}}return{opaque:t,transmissive:n,transparent:s,init:r,push:l,unshift:c,finish:d,sort:h}}function v_(){let i=new WeakMap;function e(n,s){let r=i.get(n),a;return r===void 0?(a=new md,i.set(n,[a])):s>=r.length?(a=new md,r.push(a)):a=r[s],a}function t(){i=new WeakMap}return{get:e,dispose:t}}function b_(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new k,color:new Ve};break;case"SpotLight":t={position:new k,direction:new k,color:new Ve,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new k,color:new Ve,distance:0,decay:0};break;case"HemisphereLight":t={direction:new k,skyColor:new Ve,groundColor:new Ve};break;case"RectAreaLight":t={color:new Ve,position:new k,halfWidth:new k,halfHeight:new k};break}return i[e.id]=t,t}}}function M_(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Oe};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Oe};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Oe,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[e.id]=t,t}}}var S_=0;function w_(i,e){return(e.castShadow?2:0)-(i.castShadow?2:0)+(e.map?1:0)-(i.map?1:0)}function E_(i){let e=new b_,t=M_(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new k);let s=new k,r=new ht,a=new ht;function o(c){let h=0,d=0,u=0;for(let $=0;$<9;$++)n.probe[$].set(0,0,0);let f=0,g=0,b=0,p=0,m=0,S=0,C=0,E=0,P=0,R=0,_=0,w=0,H=0,O=0;c.sort(w_);for(let $=0,te=c.length;$<te;$++){let U=c[$],j=U.color,ie=U.intensity,Z=U.distance,he=null;if(U.shadow&&U.shadow.map&&(U.shadow.map.texture.format===bi?he=U.shadow.map.texture:he=U.shadow.map.depthTexture||U.shadow.map.texture),U.isAmbientLight)h+=j.r*ie,d+=j.g*ie,u+=j.b*ie;else if(U.isLightProbe){for(let K=0;K<9;K++)n.probe[K].addScaledVector(U.sh.coefficients[K],ie);O++}else if(U.isSunLight){let K=e.get(U);if(K.color.copy(U.color).multiplyScalar(U.intensity),U.castShadow){let oe=U.shadow,le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize.copy(oe.mapSize).multiply(oe.getFrameExtents()),n.sunShadow[g]=le,n.sunShadowMap[g]=he;let Re=oe.getViewportCount();for(let Ne=0;Ne<Re;Ne++)n.sunShadowMatrix[b+Ne]=oe.getMatrix(Ne),n.sunShadowCascade[b+Ne]=oe._cascadeData[Ne];b+=Re,g++}n.sun[f]=K,f++}else if(U.isDirectionalLight){let K=e.get(U);if(K.color.copy(U.color).multiplyScalar(U.intensity),U.castShadow){let oe=U.shadow,le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize=oe.mapSize,n.directionalShadow[p]=le,n.directionalShadowMap[p]=he,n.directionalShadowMatrix[p]=U.shadow.matrix,P++}n.directional[p]=K,p++}else if(U.isSpotLight){let K=e.get(U);K.position.setFromMatrixPosition(U.matrixWorld),K.color.copy(j).multiplyScalar(ie),K.distance=Z,K.coneCos=Math.cos(U.angle),K.penumbraCos=Math.cos(U.angle*(1-U.penumbra)),K.decay=U.decay,n.spot[S]=K;let oe=U.shadow;if(U.map&&(n.spotLightMap[w]=U.map,w++,oe.updateMatrices(U),U.castShadow&&H++),n.spotLightMatrix[S]=oe.matrix,U.castShadow){let le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize=oe.mapSize,n.spotShadow[S]=le,n.spotShadowMap[S]=he,_++}S++}else if(U.isRectAreaLight){let K=e.get(U);K.color.copy(j).multiplyScalar(ie),K.halfWidth.set(U.width*.5,0,0),K.halfHeight.set(0,U.height*.5,0),n.rectArea[C]=K,C++}else if(U.isPointLight){let K=e.get(U);if(K.color.copy(U.color).multiplyScalar(U.intensity),K.distance=U.distance,K.decay=U.decay,U.castShadow){let oe=U.shadow,le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize=oe.mapSize,le.shadowCameraNear=oe.camera.near,le.shadowCameraFar=oe.camera.far,n.pointShadow[m]=le,n.pointShadowMap[m]=he,n.pointShadowMatrix[m]=U.shadow.matrix,R++}n.point[m]=K,m++}else if(U.isHemisphereLight){let K=e.get(U);K.skyColor.copy(U.color).multiplyScalar(ie),K.groundColor.copy(U.groundColor).multiplyScalar(ie),n.hemi[E]=K,E++}}C>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=ve.LTC_FLOAT_1,n.rectAreaLTC2=ve.LTC_FLOAT_2):(n.rectAreaLTC1=ve.LTC_HALF_1,n.rectAreaLTC2=ve.LTC_HALF_2)),n.ambient[0]=h,n.ambient[1]=d,n.ambient[2]=u;let z=n.hash;(z.sunLength!==f||z.directionalLength!==p||z.pointLength!==m||z.spotLength!==S||z.rectAreaLength!==C||z.hemiLength!==E||z.numSunShadows!==g||z.numDirectionalShadows!==P||z.numPointShadows!==R||z.numSpotShadows!==_||z.numSpotMaps!==w||z.numLightProbes!==O)&&(n.sun.length=f,n.directional.length=p,n.spot.length=S,n.rectArea.length=C,n.point.length=m,n.hemi.length=E,n.sunShadow.length=g,n.sunShadowMap.length=g,n.sunShadowMatrix.length=b,n.sunShadowCascade.length=b,n.directionalShadow.length=P,n.directionalShadowMap.length=P,n.directionalShadowMatrix.length=P,n.pointShadow.length=R,n.pointShadowMap.length=R,n.pointShadowMatrix.length=R,n.spotShadow.length=_,n.spotShadowMap.length=_,n.spotLightMatrix.length=_+w-H,n.spotLightMap.length=w,n.numSpotLightShadowsWithMaps=H,n.numLightProbes=O,z.sunLength=f,z.directionalLength=p,z.pointLength=m,z.spotLength=S,z.rectAreaLength=C,z.hemiLength=E,z.numSunShadows=g,z.numDirectionalShadows=P,z.numPointShadows=R,z.numSpotShadows=_,z.numSpotMaps=w,z.numLightProbes=O,n.version=S_++)}function l(c,h){let d=0,u=0,f=0,g=0,b=0,p=0,m=h.matrixWorldInverse;for(let S=0,C=c.length;S<C;S++){let E=c[S];if(E.isSunLight){let P=n.sun[d];P.direction.setFromMatrixPosition(E.matrixWorld),P.direction.transformDirection(m),d++}else if(E.isDirectionalLight){let P=n.directional[u];P.direction.setFromMatrixPosition(E.matrixWorld),s.setFromMatrixPosition(E.target.matrixWorld),P.direction.sub(s),P.direction.transformDirection(m),u++}else if(E.isSpotLight){let P=n.spot[g];P.position.setFromMatrixPosition(E.matrixWorld),P.position.applyMatrix4(m),P.direction.setFromMatrixPosition(E.matrixWorld),s.setFromMatrixPosition(E.target.matrixWorld),P.direction.sub(s),P.direction.transformDirection(m),g++}else if(E.isRectAreaLight){let P=n.rectArea[b];P.position.setFromMatrixPosition(E.matrixWorld),P.position.applyMatrix4(m),a.identity(),r.copy(E.matrixWorld),r.premultiply(m),a.extractRotation(r),P.halfWidth.set(E.width*.5,0,0),P.halfHeight.set(0,E.height*.5,0),P.halfWidth.applyMatrix4(a),P.halfHeight.applyMatrix4(a),b++}else if(E.isPointLight){let P=n.point[f];P.position.setFromMatrixPosition(E.matrixWorld),P.position.applyMatrix4(m),f++}else if(E.isHemisphereLight){let P=n.hemi[p];P.direction.setFromMatrixPosition(E.matrixWorld),P.direction.transformDirection(m),p++}}}return{setup:o,setupView:l,state:n}}function gd(i){let e=new E_(i),t=[],n=[],s=[];function r(d){h.camera=d,t.length=0,n.length=0,s.length=0}function a(d){d.isLightProbeGrid?s.push(d):t.push(d)}function o(d){n.push(d)}function l(){e.setup(t),s.sort((d,u)=>d.priority-u.priority||d.id-u.id)}function c(d){e.setupView(t,d)}let h={lightsArray:t,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:l,setupLightsView:c,pushLight:a,pushShadow:o}}function A_(i){let e=new WeakMap;function t(s,r=0){let a=e.get(s),o;return a===void 0?(o=new gd(i),e.set(s,[o])):r>=a.length?(o=new gd(i),a.push(o)):o=a[r],o}function n(){e=new WeakMap}return{get:t,dispose:n}}var T_=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,R_=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,C_=[new k(1,0,0),new k(-1,0,0),new k(0,1,0),new k(0,-1,0),new k(0,0,1),new k(0,0,-1)],P_=[new k(0,-1,0),new k(0,-1,0),new k(0,0,1),new k(0,0,-1),new k(0,-1,0),new k(0,-1,0)],yd=new ht,br=new k,Sc=new k;function I_(i,e,t){let n=new mi,s=new Oe,r=new Oe,a=new mt,o=new Da,l=new Na,c={},h=t.maxTextureSize,d={[Fn]:qt,[qt]:Fn,[Jt]:Jt},u=new Nn({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Oe},radius:{value:4}},vertexShader:T_,fragmentShader:R_}),f=u.clone();f.defines.HORIZONTAL_PASS=1;let g=new Dn;g.setAttribute("position",new vt(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let b=new Gt(g,u),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=dr;let m=this.type;this.render=function(R,_,w){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||R.length===0)return;this.type===hu&&(De("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=dr);let H=i.getRenderTarget(),O=i.getActiveCubeFace(),z=i.getActiveMipmapLevel(),$=i.state;$.setBlending(zi),$.buffers.depth.getReversed()===!0?$.buffers.color.setClear(0,0,0,0):$.buffers.color.setClear(1,1,1,1),$.buffers.depth.setTest(!0),$.setScissorTest(!1);let te=m!==this.type;te&&_.traverse(function(U){U.material&&(Array.isArray(U.material)?U.material.forEach(j=>j.needsUpdate=!0):U.material.needsUpdate=!0)});for(let U=0,j=R.length;U<j;U++){let ie=R[U],Z=ie.shadow;if(Z===void 0){De("WebGLShadowMap:",ie,"has no shadow.");continue}if(Z.autoUpdate===!1&&Z.needsUpdate===!1)continue;s.copy(Z.mapSize);let he=Z.getFrameExtents();s.multiply(he),r.copy(Z.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/he.x),s.x=r.x*he.x,Z.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/he.y),s.y=r.y*he.y,Z.mapSize.y=r.y));let K=i.state.buffers.depth.getReversed();if(Z.camera._reversedDepth=K,Z.map===null||te===!0){if(Z.map!==null&&(Z.map.depthTexture!==null&&(Z.map.depthTexture.dispose(),Z.map.depthTexture=null),Z.map.dispose()),this.type===Ss){if(ie.isPointLight){De("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}Z.map=new on(s.x,s.y,{format:bi,type:hn,minFilter:Et,magFilter:Et,generateMipmaps:!1}),Z.map.texture.name=ie.name+".shadowMap",Z.map.depthTexture=new ti(s.x,s.y,Mn),Z.map.depthTexture.name=ie.name+".shadowMapDepth",Z.map.depthTexture.format=Qn,Z.map.depthTexture.compareFunction=null,Z.map.depthTexture.minFilter=Lt,Z.map.depthTexture.magFilter=Lt}else ie.isPointLight?(Z.map=new Sr(s.x),Z.map.depthTexture=new ir(s.x,bn)):(Z.map=new on(s.x,s.y),Z.map.depthTexture=new ti(s.x,s.y,bn)),Z.map.depthTexture.name=ie.name+".shadowMap",Z.map.depthTexture.format=Qn,this.type===dr?(Z.map.depthTexture.compareFunction=K?uc:hc,Z.map.depthTexture.minFilter=Et,Z.map.depthTexture.magFilter=Et):(Z.map.depthTexture.compareFunction=null,Z.map.depthTexture.minFilter=Lt,Z.map.depthTexture.magFilter=Lt);Z.camera.updateProjectionMatrix()}Z.map.isWebGLCubeRenderTarget!==!0&&(Z.map.width!==s.x||Z.map.height!==s.y)&&Z.map.setSize(s.x,s.y);let oe=Z.map.isWebGLCubeRenderTarget?6:Z.getViewportCount();ie.isPointLight!==!0&&Z.updateMatrices(ie,w);let le=(Z.camera.layers.mask&4294967294)!==0?Z.camera.layers:w.layers;for(let Re=0;Re<oe;Re++){let Ne=Z.getCamera(Re);if(ie.isPointLight){let se=Z.camera,ye=Z.matrix,Se=ie.distance||se.far;Se!==se.far&&(se.far=Se,se.updateProjectionMatrix()),br.setFromMatrixPosition(ie.matrixWorld),se.position.copy(br),Sc.copy(se.position),Sc.add(C_[Re]),se.up.copy(P_[Re]),se.lookAt(Sc),se.updateMatrixWorld(),ye.makeTranslation(-br.x,-br.y,-br.z),yd.multiplyMatrices(se.projectionMatrix,se.matrixWorldInverse),Z._frustum.setFromProjectionMatrix(yd,se.coordinateSystem,se.reversedDepth)}if(Z.map.isWebGLCubeRenderTarget)i.setRenderTarget(Z.map,Re),i.clear();else{Re===0&&(i.setRenderTarget(Z.map),i.clear());let se=Z.getViewport(Re);a.set(r.x*se.x,r.y*se.y,r.x*se.z,r.y*se.w),$.viewport(a)}n=Z.getFrustum(Re),E(_,w,Ne,ie,le,this.type)}Z.isPointLightShadow!==!0&&this.type===Ss&&S(Z,w),Z.needsUpdate=!1}m=this.type,p.needsUpdate=!1,i.setRenderTarget(H,O,z)};function S(R,_){let w=e.update(b);u.defines.VSM_SAMPLES!==R.blurSamples&&(u.defines.VSM_SAMPLES=R.blurSamples,f.defines.VSM_SAMPLES=R.blurSamples,u.needsUpdate=!0,f.needsUpdate=!0),R.mapPass===null?R.mapPass=new on(s.x,s.y,{format:bi,type:hn}):(R.mapPass.width!==R.map.width||R.mapPass.height!==R.map.height)&&R.mapPass.setSize(R.map.width,R.map.height),u.uniforms.shadow_pass.value=R.map.depthTexture,u.uniforms.resolution.value.set(R.map.width,R.map.height),u.uniforms.radius.value=R.radius,i.setRenderTarget(R.mapPass),i.clear(),i.renderBufferDirect(_,null,w,u,b,null),f.uniforms.shadow_pass.value=R.mapPass.texture,f.uniforms.resolution.value.set(R.map.width,R.map.height),f.uniforms.radius.value=R.radius,i.setRenderTarget(R.map),i.clear(),i.renderBufferDirect(_,null,w,f,b,null)}function C(R,_,w,H){let O=null,z=w.isPointLight===!0?R.customDistanceMaterial:R.customDepthMaterial;if(z!==void 0)O=z;else if(O=w.isPointLight===!0?l:o,i.localClippingEnabled&&_.clipShadows===!0&&Array.isArray(_.clippingPlanes)&&_.clippingPlanes.length!==0||_.displacementMap&&_.displacementScale!==0||_.alphaMap&&_.alphaTest>0||_.map&&_.alphaTest>0||_.alphaToCoverage===!0){let $=O.uuid,te=_.uuid,U=c[$];U===void 0&&(U={},c[$]=U);let j=U[te];j===void 0&&(j=O.clone(),U[te]=j,_.addEventListener("dispose",P)),O=j}if(O.visible=_.visible,O.wireframe=_.wireframe,H===Ss?O.side=_.shadowSide!==null?_.shadowSide:_.side:O.side=_.shadowSide!==null?_.shadowSide:d[_.side],O.alphaMap=_.alphaMap,O.alphaTest=_.alphaToCoverage===!0?.5:_.alphaTest,O.map=_.map,O.clipShadows=_.clipShadows,O.clippingPlanes=_.clippingPlanes,O.clipIntersection=_.clipIntersection,O.displacementMap=_.displacementMap,O.displacementScale=_.displacementScale,O.displacementBias=_.displacementBias,O.wireframeLinewidth=_.wireframeLinewidth,O.linewidth=_.linewidth,w.isPointLight===!0&&O.isMeshDistanceMaterial===!0){let $=i.properties.get(O);$.light=w}return O}function E(R,_,w,H,O,z){if(R.visible===!1)return;if(R.layers.test(O)&&(R.isMesh||R.isLine||R.isPoints)&&(R.castShadow||R.receiveShadow&&z===Ss)&&(!R.frustumCulled||R.intersectsFrustum(n))){R.modelViewMatrix.multiplyMatrices(w.matrixWorldInverse,R.matrixWorld);let U=e.update(R),j=R.material;if(Array.isArray(j)){let ie=U.groups;for(let Z=0,he=ie.length;Z<he;Z++){let K=ie[Z],oe=j[K.materialIndex];if(oe&&oe.visible){let le=C(R,oe,H,z);R.onBeforeShadow(i,R,_,w,U,le,K),i.renderBufferDirect(w,null,U,le,R,K),R.onAfterShadow(i,R,_,w,U,le,K)}}}else if(j.visible){let ie=C(R,j,H,z);R.onBeforeShadow(i,R,_,w,U,ie,null),i.renderBufferDirect(w,null,U,ie,R,null),R.onAfterShadow(i,R,_,w,U,ie,null)}}let te=R.children;for(let U=0,j=te.length;U<j;U++)E(te[U],_,w,H,O,z)}function P(R){R.target.removeEventListener("dispose",P);for(let w in c){let H=c[w],O=R.target.uuid;O in H&&(H[O].dispose(),delete H[O])}}}function L_(i,e){function t(){let I=!1,re=new mt,J=null,y=new mt(0,0,0,0);return{setMask:function(M){J!==M&&!I&&(i.colorMask(M,M,M,M),J=M)},setLocked:function(M){I=M},setClear:function(M,T,F,D,L){L===!0&&(M*=D,T*=D,F*=D),re.set(M,T,F,D),y.equals(re)===!1&&(i.clearColor(M,T,F,D),y.copy(re))},reset:function(){I=!1,J=null,y.set(-1,0,0,0)}}}function n(){let I=!1,re=!1,J=null,y=null,M=null;return{setReversed:function(T){if(re!==T){let F=e.get("EXT_clip_control");T?F.clipControlEXT(F.LOWER_LEFT_EXT,F.ZERO_TO_ONE_EXT):F.clipControlEXT(F.LOWER_LEFT_EXT,F.NEGATIVE_ONE_TO_ONE_EXT),re=T;let D=M;M=null,this.setClear(D)}},getReversed:function(){return re},setTest:function(T){T?_e(i.DEPTH_TEST):Be(i.DEPTH_TEST)},setMask:function(T){J!==T&&!I&&(i.depthMask(T),J=T)},setFunc:function(T){if(re&&(T=Wu[T]),y!==T){switch(T){case xa:i.depthFunc(i.NEVER);break;case va:i.depthFunc(i.ALWAYS);break;case ba:i.depthFunc(i.LESS);break;case ds:i.depthFunc(i.LEQUAL);break;case Ma:i.depthFunc(i.EQUAL);break;case Sa:i.depthFunc(i.GEQUAL);break;case wa:i.depthFunc(i.GREATER);break;case Ea:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}y=T}},setLocked:function(T){I=T},setClear:function(T){M!==T&&(M=T,re&&(T=1-T),i.clearDepth(T))},reset:function(){I=!1,J=null,y=null,M=null,re=!1}}}function s(){let I=!1,re=null,J=null,y=null,M=null,T=null,F=null,D=null,L=null;return{setTest:function(q){I||(q?_e(i.STENCIL_TEST):Be(i.STENCIL_TEST))},setMask:function(q){re!==q&&!I&&(i.stencilMask(q),re=q)},setFunc:function(q,Q,X){(J!==q||y!==Q||M!==X)&&(i.stencilFunc(q,Q,X),J=q,y=Q,M=X)},setOp:function(q,Q,X){(T!==q||F!==Q||D!==X)&&(i.stencilOp(q,Q,X),T=q,F=Q,D=X)},setLocked:function(q){I=q},setClear:function(q){L!==q&&(i.clearStencil(q),L=q)},reset:function(){I=!1,re=null,J=null,y=null,M=null,T=null,F=null,D=null,L=null}}}let r=new t,a=new n,o=new s,l={},c=new WeakMap,h={},d={},u={},f=new WeakMap,g=[],b=null,p=!1,m=null,S=null,C=null,E=null,P=null,R=null,_=null,w=new Ve(0,0,0),H=0,O=!1,z=null,$=null,te=null,U=null,j=null,ie=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),Z=!1,he=0,K=i.getParameter(i.VERSION);K.indexOf("WebGL")!==-1?(he=parseFloat(/^WebGL (\d)/.exec(K)[1]),Z=he>=1):K.indexOf("OpenGL ES")!==-1&&(he=parseFloat(/^OpenGL ES (\d)/.exec(K)[1]),Z=he>=2);let oe=null,le={},Re=i.getParameter(i.SCISSOR_BOX),Ne=i.getParameter(i.VIEWPORT),se=new mt().fromArray(Re),ye=new mt().fromArray(Ne);function Se(I,re,J,y){let M=new Uint8Array(4),T=i.createTexture();i.bindTexture(I,T),i.texParameteri(I,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(I,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let F=0;F<J;F++)I===i.TEXTURE_3D||I===i.TEXTURE_2D_ARRAY?i.texImage3D(re,0,i.RGBA,1,1,y,0,i.RGBA,i.UNSIGNED_BYTE,M):i.texImage2D(re+F,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,M);return T}let Le={};Le[i.TEXTURE_2D]=Se(i.TEXTURE_2D,i.TEXTURE_2D,1),Le[i.TEXTURE_CUBE_MAP]=Se(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Le[i.TEXTURE_2D_ARRAY]=Se(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Le[i.TEXTURE_3D]=Se(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),a.setClear(1),o.setClear(0),_e(i.DEPTH_TEST),a.setFunc(ds),bt(!1),ut(Hl),_e(i.CULL_FACE),At(zi);function _e(I){h[I]!==!0&&(i.enable(I),h[I]=!0)}function Be(I){h[I]!==!1&&(i.disable(I),h[I]=!1)}function ot(I,re){return u[I]!==re?(i.bindFramebuffer(I,re),u[I]=re,I===i.DRAW_FRAMEBUFFER&&(u[i.FRAMEBUFFER]=re),I===i.FRAMEBUFFER&&(u[i.DRAW_FRAMEBUFFER]=re),!0):!1}function Pe(I,re){let J=g,y=!1;if(I){J=f.get(re),J===void 0&&(J=[],f.set(re,J));let M=I.textures;if(J.length!==M.length||J[0]!==i.COLOR_ATTACHMENT0){for(let T=0,F=M.length;T<F;T++)J[T]=i.COLOR_ATTACHMENT0+T;J.length=M.length,y=!0}}else J[0]!==i.BACK&&(J[0]=i.BACK,y=!0);y&&i.drawBuffers(J)}function Ke(I){return b!==I?(i.useProgram(I),b=I,!0):!1}let Qe={[Gi]:i.FUNC_ADD,[du]:i.FUNC_SUBTRACT,[fu]:i.FUNC_REVERSE_SUBTRACT};Qe[pu]=i.MIN,Qe[mu]=i.MAX;let qe={[gu]:i.ZERO,[yu]:i.ONE,[_u]:i.SRC_COLOR,[Yl]:i.SRC_ALPHA,[wu]:i.SRC_ALPHA_SATURATE,[Mu]:i.DST_COLOR,[vu]:i.DST_ALPHA,[xu]:i.ONE_MINUS_SRC_COLOR,[$l]:i.ONE_MINUS_SRC_ALPHA,[Su]:i.ONE_MINUS_DST_COLOR,[bu]:i.ONE_MINUS_DST_ALPHA,[Eu]:i.CONSTANT_COLOR,[Au]:i.ONE_MINUS_CONSTANT_COLOR,[Tu]:i.CONSTANT_ALPHA,[Ru]:i.ONE_MINUS_CONSTANT_ALPHA};function At(I,re,J,y,M,T,F,D,L,q){if(I===zi){p===!0&&(Be(i.BLEND),p=!1);return}if(p===!1&&(_e(i.BLEND),p=!0),I!==uu){if(I!==m||q!==O){if((S!==Gi||P!==Gi)&&(i.blendEquation(i.FUNC_ADD),S=Gi,P=Gi),q)switch(I){case ws:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case Wl:i.blendFunc(i.ONE,i.ONE);break;case Xl:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case ql:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:Fe("WebGLState: Invalid blending: ",I);break}else switch(I){case ws:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case Wl:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case Xl:Fe("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case ql:Fe("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Fe("WebGLState: Invalid blending: ",I);break}C=null,E=null,R=null,_=null,w.set(0,0,0),H=0,m=I,O=q}return}M=M||re,T=T||J,F=F||y,(re!==S||M!==P)&&(i.blendEquationSeparate(Qe[re],Qe[M]),S=re,P=M),(J!==C||y!==E||T!==R||F!==_)&&(i.blendFuncSeparate(qe[J],qe[y],qe[T],qe[F]),C=J,E=y,R=T,_=F),(D.equals(w)===!1||L!==H)&&(i.blendColor(D.r,D.g,D.b,L),w.copy(D),H=L),m=I,O=!1}function yt(I,re){I.side===Jt?Be(i.CULL_FACE):_e(i.CULL_FACE);let J=I.side===qt;re&&(J=!J),bt(J),I.blending===ws&&I.transparent===!1?At(zi):At(I.blending,I.blendEquation,I.blendSrc,I.blendDst,I.blendEquationAlpha,I.blendSrcAlpha,I.blendDstAlpha,I.blendColor,I.blendAlpha,I.premultipliedAlpha),a.setFunc(I.depthFunc),a.setTest(I.depthTest),a.setMask(I.depthWrite),r.setMask(I.colorWrite);let y=I.stencilWrite;o.setTest(y),y&&(o.setMask(I.stencilWriteMask),o.setFunc(I.stencilFunc,I.stencilRef,I.stencilFuncMask),o.setOp(I.stencilFail,I.stencilZFail,I.stencilZPass)),Mt(I.polygonOffset,I.polygonOffsetFactor,I.polygonOffsetUnits),I.alphaToCoverage===!0?_e(i.SAMPLE_ALPHA_TO_COVERAGE):Be(i.SAMPLE_ALPHA_TO_COVERAGE)}function bt(I){z!==I&&(I?i.frontFace(i.CW):i.frontFace(i.CCW),z=I)}function ut(I){I!==lu?(_e(i.CULL_FACE),I!==$&&(I===Hl?i.cullFace(i.BACK):I===cu?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):Be(i.CULL_FACE),$=I}function un(I){I!==te&&(Z&&i.lineWidth(I),te=I)}function Mt(I,re,J){I?(_e(i.POLYGON_OFFSET_FILL),(U!==re||j!==J)&&(U=re,j=J,a.getReversed()&&(re=-re,J=-J),i.polygonOffset(re,J))):Be(i.POLYGON_OFFSET_FILL)}function Yt(I){I?_e(i.SCISSOR_TEST):Be(i.SCISSOR_TEST)}function $t(I){I===void 0&&(I=i.TEXTURE0+ie-1),oe!==I&&(i.activeTexture(I),oe=I)}function Zt(I,re,J){J===void 0&&(oe===null?J=i.TEXTURE0+ie-1:J=oe);let y=le[J];y===void 0&&(y={type:void 0,texture:void 0},le[J]=y),(y.type!==I||y.texture!==re)&&(oe!==J&&(i.activeTexture(J),oe=J),i.bindTexture(I,re||Le[I]),y.type=I,y.texture=re)}function B(){let I=le[oe];I!==void 0&&I.type!==void 0&&(i.bindTexture(I.type,null),I.type=void 0,I.texture=void 0)}function Kt(){try{i.compressedTexImage2D(...arguments)}catch(I){Fe("WebGLState:",I)}}function rt(){try{i.compressedTexImage3D(...arguments)}catch(I){Fe("WebGLState:",I)}}function lt(){try{i.texSubImage2D(...arguments)}catch(I){Fe("WebGLState:",I)}}function ge(){try{i.texSubImage3D(...arguments)}catch(I){Fe("WebGLState:",I)}}function xt(){try{i.compressedTexSubImage2D(...arguments)}catch(I){Fe("WebGLState:",I)}}function Ie(){try{i.compressedTexSubImage3D(...arguments)}catch(I){Fe("WebGLState:",I)}}function Ue(){try{i.texStorage2D(...arguments)}catch(I){Fe("WebGLState:",I)}}function A(){try{i.texStorage3D(...arguments)}catch(I){Fe("WebGLState:",I)}}function x(){try{i.texImage2D(...arguments)}catch(I){Fe("WebGLState:",I)}}function G(){try{i.texImage3D(...arguments)}catch(I){Fe("WebGLState:",I)}}function ce(I){return d[I]!==void 0?d[I]:i.getParameter(I)}function ae(I,re){d[I]!==re&&(i.pixelStorei(I,re),d[I]=re)}function ue(I){se.equals(I)===!1&&(i.scissor(I.x,I.y,I.z,I.w),se.copy(I))}function de(I){ye.equals(I)===!1&&(i.viewport(I.x,I.y,I.z,I.w),ye.copy(I))}function ee(I,re){let J=c.get(re);J===void 0&&(J=new WeakMap,c.set(re,J));let y=J.get(I);y===void 0&&(y=i.getUniformBlockIndex(re,I.name),i.uniformBlockBinding(re,y,y),J.set(I,y))}function ne(I,re,J){let M=c.get(re).get(I);l[M]!==J&&(i.bindBufferBase(i.UNIFORM_BUFFER,M,J),l[M]=J)}function fe(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),a.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),h={},d={},oe=null,le={},u={},l={},f=new WeakMap,g=[],b=null,p=!1,m=null,S=null,C=null,E=null,P=null,R=null,_=null,w=new Ve(0,0,0),H=0,O=!1,z=null,$=null,te=null,U=null,j=null,se.set(0,0,i.canvas.width,i.canvas.height),ye.set(0,0,i.canvas.width,i.canvas.height),r.reset(),a.reset(),o.reset()}return{buffers:{color:r,depth:a,stencil:o},enable:_e,disable:Be,bindFramebuffer:ot,drawBuffers:Pe,useProgram:Ke,setBlending:At,setMaterial:yt,setFlipSided:bt,setCullFace:ut,setLineWidth:un,setPolygonOffset:Mt,setScissorTest:Yt,activeTexture:$t,bindTexture:Zt,unbindTexture:B,compressedTexImage2D:Kt,compressedTexImage3D:rt,texImage2D:x,texImage3D:G,pixelStorei:ae,getParameter:ce,updateUBOMapping:ee,uniformBlockBinding:ne,texStorage2D:Ue,texStorage3D:A,texSubImage2D:lt,texSubImage3D:ge,compressedTexSubImage2D:xt,compressedTexSubImage3D:Ie,scissor:ue,viewport:de,reset:fe}}function D_(i,e,t,n,s,r,a){let o=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new Oe,h=new WeakMap,d=new Set,u,f=new WeakMap,g=new Set,b=new FinalizationRegistry(A=>g.delete(A)),p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function m(A,x){return p?new OffscreenCanvas(A,x):Zs("canvas")}function S(A,x,G){let ce=1,ae=Ue(A);if((ae.width>G||ae.height>G)&&(ce=G/Math.max(ae.width,ae.height)),ce<1)if(typeof HTMLImageElement<"u"&&A instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&A instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&A instanceof ImageBitmap||typeof VideoFrame<"u"&&A instanceof VideoFrame){let ue=Math.floor(ce*ae.width),de=Math.floor(ce*ae.height);u===void 0&&(u=m(ue,de));let ee=x?m(ue,de):u;return ee.width=ue,ee.height=de,ee.getContext("2d").drawImage(A,0,0,ue,de),De("WebGLRenderer: Texture has been resized from ("+ae.width+"x"+ae.height+") to ("+ue+"x"+de+")."),ee}else return"data"in A&&De("WebGLRenderer: Image in DataTexture is too big ("+ae.width+"x"+ae.height+")."),A;return A}function C(A){return A.generateMipmaps}function E(A){i.generateMipmap(A)}function P(A){return A.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:A.isWebGL3DRenderTarget?i.TEXTURE_3D:A.isWebGLArrayRenderTarget||A.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function R(A,x,G,ce,ae,ue=!1){if(A!==null){if(i[A]!==void 0)return i[A];De("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+A+"'")}let de;ce&&(de=e.get("EXT_texture_norm16"),de||De("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let ee=x;if(x===i.RED&&(G===i.FLOAT&&(ee=i.R32F),G===i.HALF_FLOAT&&(ee=i.R16F),G===i.UNSIGNED_BYTE&&(ee=i.R8),G===i.UNSIGNED_SHORT&&de&&(ee=de.R16_EXT),G===i.SHORT&&de&&(ee=de.R16_SNORM_EXT)),x===i.RED_INTEGER&&(G===i.UNSIGNED_BYTE&&(ee=i.R8UI),G===i.UNSIGNED_SHORT&&(ee=i.R16UI),G===i.UNSIGNED_INT&&(ee=i.R32UI),G===i.BYTE&&(ee=i.R8I),G===i.SHORT&&(ee=i.R16I),G===i.INT&&(ee=i.R32I)),x===i.RG&&(G===i.FLOAT&&(ee=i.RG32F),G===i.HALF_FLOAT&&(ee=i.RG16F),G===i.UNSIGNED_BYTE&&(ee=i.RG8),G===i.UNSIGNED_SHORT&&de&&(ee=de.RG16_EXT),G===i.SHORT&&de&&(ee=de.RG16_SNORM_EXT)),x===i.RG_INTEGER&&(G===i.UNSIGNED_BYTE&&(ee=i.RG8UI),G===i.UNSIGNED_SHORT&&(ee=i.RG16UI),G===i.UNSIGNED_INT&&(ee=i.RG32UI),G===i.BYTE&&(ee=i.RG8I),G===i.SHORT&&(ee=i.RG16I),G===i.INT&&(ee=i.RG32I)),x===i.RGB_INTEGER&&(G===i.UNSIGNED_BYTE&&(ee=i.RGB8UI),G===i.UNSIGNED_SHORT&&(ee=i.RGB16UI),G===i.UNSIGNED_INT&&(ee=i.RGB32UI),G===i.BYTE&&(ee=i.RGB8I),G===i.SHORT&&(ee=i.RGB16I),G===i.INT&&(ee=i.RGB32I)),x===i.RGBA_INTEGER&&(G===i.UNSIGNED_BYTE&&(ee=i.RGBA8UI),G===i.UNSIGNED_SHORT&&(ee=i.RGBA16UI),G===i.UNSIGNED_INT&&(ee=i.RGBA32UI),G===i.BYTE&&(ee=i.RGBA8I),G===i.SHORT&&(ee=i.RGBA16I),G===i.INT&&(ee=i.RGBA32I)),x===i.RGB&&(G===i.UNSIGNED_SHORT&&de&&(ee=de.RGB16_EXT),G===i.SHORT&&de&&(ee=de.RGB16_SNORM_EXT),G===i.UNSIGNED_INT_5_9_9_9_REV&&(ee=i.RGB9_E5),G===i.UNSIGNED_INT_10F_11F_11F_REV&&(ee=i.R11F_G11F_B10F)),x===i.RGBA){let ne=ue?$s:Ze.getTransfer(ae);G===i.FLOAT&&(ee=i.RGBA32F),G===i.HALF_FLOAT&&(ee=i.RGBA16F),G===i.UNSIGNED_BYTE&&(ee=ne===it?i.SRGB8_ALPHA8:i.RGBA8),G===i.UNSIGNED_SHORT&&de&&(ee=de.RGBA16_EXT),G===i.SHORT&&de&&(ee=de.RGBA16_SNORM_EXT),G===i.UNSIGNED_SHORT_4_4_4_4&&(ee=i.RGBA4),G===i.UNSIGNED_SHORT_5_5_5_1&&(ee=i.RGB5_A1)}return(ee===i.R16F||ee===i.R32F||ee===i.RG16F||ee===i.RG32F||ee===i.RGBA16F||ee===i.RGBA32F)&&e.get("EXT_color_buffer_float"),ee}function _(A,x){let G;return A?x===null||x===bn||x===Hi?G=i.DEPTH24_STENCIL8:x===Mn?G=i.DEPTH32F_STENCIL8:x===Ts&&(G=i.DEPTH24_STENCIL8,De("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):x===null||x===bn||x===Hi?G=i.DEPTH_COMPONENT24:x===Mn?G=i.DEPTH_COMPONENT32F:x===Ts&&(G=i.DEPTH_COMPONENT16),G}function w(A,x){return C(A)===!0||A.isFramebufferTexture&&A.minFilter!==Lt&&A.minFilter!==Et?Math.log2(Math.max(x.width,x.height))+1:A.mipmaps.length>0?A.mipmaps.length:A.isCompressedTexture&&Array.isArray(A.image)?x.mipmaps.length:1}function H(A){let x=new WeakRef(A);n.get(A).__ref=x,g.add(x),b.register(A,x,x)}function O(A){let x=n.get(A).__ref;x!==void 0&&(g.delete(x),b.unregister(x))}function z(A){te(A.target)}function $(A){U(A.target)}function te(A){A.removeEventListener("dispose",z),O(A),ie(A),A.isVideoTexture&&h.delete(A),A.isHTMLTexture&&d.delete(A)}function U(A){A.removeEventListener("dispose",$),O(A),he(A)}function j(){for(let A of g){let x=A.deref();x!==void 0&&(x.isRenderTarget===!0?U(x):te(x))}g.clear(),d.clear()}function ie(A){let x=n.get(A);if(x.__webglInit===void 0)return;let G=A.source,ce=f.get(G);if(ce){let ae=ce[x.__cacheKey];ae.usedTimes--,ae.usedTimes===0&&Z(A),Object.keys(ce).length===0&&f.delete(G)}n.remove(A)}function Z(A){let x=n.get(A);i.deleteTexture(x.__webglTexture);let G=A.source,ce=f.get(G);delete ce[x.__cacheKey],a.memory.textures--}function he(A){let x=n.get(A);x.__depthDisposeCallback&&x.__depthDisposeCallback();let G=A.depthTexture;if(G&&G.renderTarget===A&&te(G),A.isWebGLCubeRenderTarget)for(let ae=0;ae<6;ae++){if(Array.isArray(x.__webglFramebuffer[ae]))for(let ue=0;ue<x.__webglFramebuffer[ae].length;ue++)i.deleteFramebuffer(x.__webglFramebuffer[ae][ue]);else i.deleteFramebuffer(x.__webglFramebuffer[ae]);x.__webglDepthbuffer&&i.deleteRenderbuffer(x.__webglDepthbuffer[ae])}else{if(Array.isArray(x.__webglFramebuffer))for(let ae=0;ae<x.__webglFramebuffer.length;ae++)i.deleteFramebuffer(x.__webglFramebuffer[ae]);else i.deleteFramebuffer(x.__webglFramebuffer);if(x.__webglDepthbuffer&&i.deleteRenderbuffer(x.__webglDepthbuffer),x.__webglMultisampledFramebuffer&&i.deleteFramebuffer(x.__webglMultisampledFramebuffer),x.__webglColorRenderbuffer)for(let ae=0;ae<x.__webglColorRenderbuffer.length;ae++)x.__webglColorRenderbuffer[ae]&&i.deleteRenderbuffer(x.__webglColorRenderbuffer[ae]);x.__webglDepthRenderbuffer&&i.deleteRenderbuffer(x.__webglDepthRenderbuffer)}let ce=A.textures;for(let ae=0,ue=ce.length;ae<ue;ae++){let de=n.get(ce[ae]);de.__webglTexture&&(i.deleteTexture(de.__webglTexture),a.memory.textures--),n.remove(ce[ae])}n.remove(A)}let K=0;function oe(){K=0}function le(){return K}function Re(A){K=A}function Ne(){let A=K;return A>=s.maxTextures&&De("WebGLTextures: Trying to use "+(A+1)+" texture units while this GPU supports only "+s.maxTextures),K+=1,A}function se(A){let x=[];return x.push(A.wrapS),x.push(A.wrapT),x.push(A.wrapR||0),x.push(A.magFilter),x.push(A.minFilter),x.push(A.anisotropy),x.push(A.internalFormat),x.push(A.format),x.push(A.type),x.push(A.generateMipmaps),x.push(A.mipmapsAutoUpdate),x.push(A.premultiplyAlpha),x.push(A.flipY),x.push(A.unpackAlignment),x.push(A.colorSpace),x.join()}function ye(A,x){let G=n.get(A);if(A.isVideoTexture&&xt(A),A.isRenderTargetTexture===!1&&A.isExternalTexture!==!0&&A.version>0&&G.__version!==A.version){let ce=A.image;if(ce===null)De("WebGLRenderer: Texture marked for update but no image data found.");else if(ce.complete===!1)De("WebGLRenderer: Texture marked for update but image is incomplete");else{yt(G,A,x);return}}else A.isExternalTexture&&(G.__webglTexture=A.sourceTexture?A.sourceTexture:null);t.bindTexture(i.TEXTURE_2D,G.__webglTexture,i.TEXTURE0+x)}function Se(A,x){let G=n.get(A);if(A.isRenderTargetTexture===!1&&A.version>0&&G.__version!==A.version){yt(G,A,x);return}else A.isExternalTexture&&(G.__webglTexture=A.sourceTexture?A.sourceTexture:null);t.bindTexture(i.TEXTURE_2D_ARRAY,G.__webglTexture,i.TEXTURE0+x)}function Le(A,x){let G=n.get(A);if(A.isRenderTargetTexture===!1&&A.version>0&&G.__version!==A.version){yt(G,A,x);return}t.bindTexture(i.TEXTURE_3D,G.__webglTexture,i.TEXTURE0+x)}function _e(A,x){let G=n.get(A);if(A.version>0&&G.__version!==A.version){bt(G,A,x);return}t.bindTexture(i.TEXTURE_CUBE_MAP,G.__webglTexture,i.TEXTURE0+x)}let Be={[fs]:i.REPEAT,[In]:i.CLAMP_TO_EDGE,[Aa]:i.MIRRORED_REPEAT},ot={[Lt]:i.NEAREST,[Iu]:i.NEAREST_MIPMAP_NEAREST,[pr]:i.NEAREST_MIPMAP_LINEAR,[Et]:i.LINEAR,[$a]:i.LINEAR_MIPMAP_NEAREST,[ni]:i.LINEAR_MIPMAP_LINEAR},Pe={[Uu]:i.NEVER,[dc]:i.ALWAYS,[Fu]:i.LESS,[hc]:i.LEQUAL,[Ou]:i.EQUAL,[uc]:i.GEQUAL,[Bu]:i.GREATER,[ku]:i.NOTEQUAL};function Ke(A,x){if(x.type===Mn&&e.has("OES_texture_float_linear")===!1&&(x.magFilter===Et||x.magFilter===$a||x.magFilter===pr||x.magFilter===ni||x.minFilter===Et||x.minFilter===$a||x.minFilter===pr||x.minFilter===ni)&&De("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(A,i.TEXTURE_WRAP_S,Be[x.wrapS]),i.texParameteri(A,i.TEXTURE_WRAP_T,Be[x.wrapT]),(A===i.TEXTURE_3D||A===i.TEXTURE_2D_ARRAY)&&i.texParameteri(A,i.TEXTURE_WRAP_R,Be[x.wrapR]),i.texParameteri(A,i.TEXTURE_MAG_FILTER,ot[x.magFilter]),i.texParameteri(A,i.TEXTURE_MIN_FILTER,ot[x.minFilter]),x.compareFunction&&(i.texParameteri(A,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(A,i.TEXTURE_COMPARE_FUNC,Pe[x.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(x.magFilter===Lt||x.minFilter!==pr&&x.minFilter!==ni||x.type===Mn&&e.has("OES_texture_float_linear")===!1)return;if(x.anisotropy>1||n.get(x).__currentAnisotropy){let G=e.get("EXT_texture_filter_anisotropic");i.texParameterf(A,G.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(x.anisotropy,s.getMaxAnisotropy())),n.get(x).__currentAnisotropy=x.anisotropy}}}function Qe(A,x){let G=!1;A.__webglInit===void 0&&(A.__webglInit=!0,x.addEventListener("dispose",z),H(x));let ce=x.source,ae=f.get(ce);ae===void 0&&(ae={},f.set(ce,ae));let ue=se(x);if(ue!==A.__cacheKey){ae[ue]===void 0&&(ae[ue]={texture:i.createTexture(),usedTimes:0},a.memory.textures++,G=!0),ae[ue].usedTimes++;let de=ae[A.__cacheKey];de!==void 0&&(ae[A.__cacheKey].usedTimes--,de.usedTimes===0&&Z(x)),A.__cacheKey=ue,A.__webglTexture=ae[ue].texture}return G}function qe(A,x,G){return Math.floor(Math.floor(A/G)/x)}function At(A,x,G,ce){let ue=A.updateRanges;if(ue.length===0)t.texSubImage2D(i.TEXTURE_2D,0,0,0,x.width,x.height,G,ce,x.data);else{ue.sort((I,re)=>I.start-re.start);let de=0;for(let I=1;I<ue.length;I++){let re=ue[de],J=ue[I],y=re.start+re.count,M=qe(J.start,x.width,4),T=qe(re.start,x.width,4);J.start<=y+1&&M===T&&qe(J.start+J.count-1,x.width,4)===M?re.count=Math.max(re.count,J.start+J.count-re.start):(++de,ue[de]=J)}ue.length=de+1;let ee=t.getParameter(i.UNPACK_ROW_LENGTH),ne=t.getParameter(i.UNPACK_SKIP_PIXELS),fe=t.getParameter(i.UNPACK_SKIP_ROWS);t.pixelStorei(i.UNPACK_ROW_LENGTH,x.width);for(let I=0,re=ue.length;I<re;I++){let J=ue[I],y=Math.floor(J.start/4),M=Math.ceil(J.count/4),T=y%x.width,F=Math.floor(y/x.width),D=M,L=1;t.pixelStorei(i.UNPACK_SKIP_PIXELS,T),t.pixelStorei(i.UNPACK_SKIP_ROWS,F),t.texSubImage2D(i.TEXTURE_2D,0,T,F,D,L,G,ce,x.data)}A.clearUpdateRanges(),t.pixelStorei(i.UNPACK_ROW_LENGTH,ee),t.pixelStorei(i.UNPACK_SKIP_PIXELS,ne),t.pixelStorei(i.UNPACK_SKIP_ROWS,fe)}}function yt(A,x,G){let ce=i.TEXTURE_2D;(x.isDataArrayTexture||x.isCompressedArrayTexture)&&(ce=i.TEXTURE_2D_ARRAY),x.isData3DTexture&&(ce=i.TEXTURE_3D);let ae=Qe(A,x),ue=x.source;t.bindTexture(ce,A.__webglTexture,i.TEXTURE0+G);let de=n.get(ue);if(ue.version!==de.__version||ae===!0){if(t.activeTexture(i.TEXTURE0+G),(typeof ImageBitmap<"u"&&x.image instanceof ImageBitmap)===!1){let L=Ze.getPrimaries(Ze.workingColorSpace),q=x.colorSpace===wn?null:Ze.getPrimaries(x.colorSpace),Q=x.colorSpace===wn||L===q?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,x.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,x.premultiplyAlpha),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,Q)}t.pixelStorei(i.UNPACK_ALIGNMENT,x.unpackAlignment);let ne=S(x.image,!1,s.maxTextureSize);ne=Ie(x,ne);let fe=r.convert(x.format,x.colorSpace),I=r.convert(x.type),re=R(x.internalFormat,fe,I,x.normalized,x.colorSpace,x.isVideoTexture);Ke(ce,x);let J,y=x.mipmaps,M=x.isVideoTexture!==!0,T=de.__version===void 0||ae===!0,F=ue.dataReady,D=w(x,ne);if(x.isDepthTexture)re=_(x.format===ii,x.type),T&&(M?t.texStorage2D(i.TEXTURE_2D,1,re,ne.width,ne.height):t.texImage2D(i.TEXTURE_2D,0,re,ne.width,ne.height,0,fe,I,null));else if(x.isDataTexture)if(y.length>0){M&&T&&t.texStorage2D(i.TEXTURE_2D,D,re,y[0].width,y[0].height);for(let L=0,q=y.length;L<q;L++)J=y[L],M?F&&t.texSubImage2D(i.TEXTURE_2D,L,0,0,J.width,J.height,fe,I,J.data):t.texImage2D(i.TEXTURE_2D,L,re,J.width,J.height,0,fe,I,J.data);x.generateMipmaps=!1}else M?(T&&t.texStorage2D(i.TEXTURE_2D,D,re,ne.width,ne.height),F&&At(x,ne,fe,I)):t.texImage2D(i.TEXTURE_2D,0,re,ne.width,ne.height,0,fe,I,ne.data);else if(x.isCompressedTexture)if(x.isCompressedArrayTexture){M&&T&&t.texStorage3D(i.TEXTURE_2D_ARRAY,D,re,y[0].width,y[0].height,ne.depth);for(let L=0,q=y.length;L<q;L++)if(J=y[L],x.format!==Sn)if(fe!==null)if(M){if(F)if(x.layerUpdates.size>0){let Q=bc(J.width,J.height,x.format,x.type);for(let X of x.layerUpdates){let be=J.data.subarray(X*Q/J.data.BYTES_PER_ELEMENT,(X+1)*Q/J.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,L,0,0,X,J.width,J.height,1,fe,be)}}else t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,L,0,0,0,J.width,J.height,ne.depth,fe,J.data)}else t.compressedTexImage3D(i.TEXTURE_2D_ARRAY,L,re,J.width,J.height,ne.depth,0,J.data,0,0);else De("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else M?F&&t.texSubImage3D(i.TEXTURE_2D_ARRAY,L,0,0,0,J.width,J.height,ne.depth,fe,I,J.data):t.texImage3D(i.TEXTURE_2D_ARRAY,L,re,J.width,J.height,ne.depth,0,fe,I,J.data);x.layerUpdates.size>0&&x.clearLayerUpdates()}else{M&&T&&t.texStorage2D(i.TEXTURE_2D,D,re,y[0].width,y[0].height);for(let L=0,q=y.length;L<q;L++)J=y[L],x.format!==Sn?fe!==null?M?F&&t.compressedTexSubImage2D(i.TEXTURE_2D,L,0,0,J.width,J.height,fe,J.data):t.compressedTexImage2D(i.TEXTURE_2D,L,re,J.width,J.height,0,J.data):De("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):M?F&&t.texSubImage2D(i.TEXTURE_2D,L,0,0,J.width,J.height,fe,I,J.data):t.texImage2D(i.TEXTURE_2D,L,re,J.width,J.height,0,fe,I,J.data)}else if(x.isDataArrayTexture)if(M){if(T&&t.texStorage3D(i.TEXTURE_2D_ARRAY,D,re,ne.width,ne.height,ne.depth),F)if(x.layerUpdates.size>0){let L=bc(ne.width,ne.height,x.format,x.type);for(let q of x.layerUpdates){let Q=ne.data.subarray(q*L/ne.data.BYTES_PER_ELEMENT,(q+1)*L/ne.data.BYTES_PER_ELEMENT);t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,q,ne.width,ne.height,1,fe,I,Q)}x.clearLayerUpdates()}else t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,ne.width,ne.height,ne.depth,fe,I,ne.data)}else t.texImage3D(i.TEXTURE_2D_ARRAY,0,re,ne.width,ne.height,ne.depth,0,fe,I,ne.data);else if(x.isData3DTexture)M?(T&&t.texStorage3D(i.TEXTURE_3D,D,re,ne.width,ne.height,ne.depth),F&&t.texSubImage3D(i.TEXTURE_3D,0,0,0,0,ne.width,ne.height,ne.depth,fe,I,ne.data)):t.texImage3D(i.TEXTURE_3D,0,re,ne.width,ne.height,ne.depth,0,fe,I,ne.data);else if(x.isFramebufferTexture){if(T)if(M)t.texStorage2D(i.TEXTURE_2D,D,re,ne.width,ne.height);else{let L=ne.width,q=ne.height;for(let Q=0;Q<D;Q++)t.texImage2D(i.TEXTURE_2D,Q,re,L,q,0,fe,I,null),L>>=1,q>>=1}}else if(x.isHTMLTexture){if("texElementImage2D"in i){let L=i.canvas;if(L.hasAttribute("layoutsubtree")||L.setAttribute("layoutsubtree","true"),ne.parentNode!==L){L.appendChild(ne),d.add(x),L.onpaint=q=>{let Q=q.changedElements;for(let X of d)Q.includes(X.image)&&(X.needsUpdate=!0)},L.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,ne);else{let Q=i.RGBA,X=i.RGBA,be=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,Q,X,be,ne)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(y.length>0){if(M&&T){let L=Ue(y[0]);t.texStorage2D(i.TEXTURE_2D,D,re,L.width,L.height)}for(let L=0,q=y.length;L<q;L++)J=y[L],M?F&&t.texSubImage2D(i.TEXTURE_2D,L,0,0,fe,I,J):t.texImage2D(i.TEXTURE_2D,L,re,fe,I,J);x.generateMipmaps=!1}else if(M){if(T){let L=Ue(ne);t.texStorage2D(i.TEXTURE_2D,D,re,L.width,L.height)}F&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,fe,I,ne)}else t.texImage2D(i.TEXTURE_2D,0,re,fe,I,ne);C(x)&&x.mipmapsAutoUpdate===!0&&E(ce),de.__version=ue.version,x.onUpdate&&x.onUpdate(x)}A.__version=x.version}function bt(A,x,G){if(x.image.length!==6)return;let ce=Qe(A,x),ae=x.source;t.bindTexture(i.TEXTURE_CUBE_MAP,A.__webglTexture,i.TEXTURE0+G);let ue=n.get(ae);if(ae.version!==ue.__version||ce===!0){t.activeTexture(i.TEXTURE0+G);let de=Ze.getPrimaries(Ze.workingColorSpace),ee=x.colorSpace===wn?null:Ze.getPrimaries(x.colorSpace),ne=x.colorSpace===wn||de===ee?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,x.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,x.premultiplyAlpha),t.pixelStorei(i.UNPACK_ALIGNMENT,x.unpackAlignment),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,ne);let fe=x.isCompressedTexture||x.image[0].isCompressedTexture,I=x.image[0]&&x.image[0].isDataTexture,re=[];for(let X=0;X<6;X++)!fe&&!I?re[X]=S(x.image[X],!0,s.maxCubemapSize):re[X]=I?x.image[X].image:x.image[X],re[X]=Ie(x,re[X]);let J=re[0],y=r.convert(x.format,x.colorSpace),M=r.convert(x.type),T=R(x.internalFormat,y,M,x.normalized,x.colorSpace),F=x.isVideoTexture!==!0,D=ue.__version===void 0||ce===!0,L=ae.dataReady,q=w(x,J);Ke(i.TEXTURE_CUBE_MAP,x);let Q;if(x.isDepthTexture){if(T=_(x.format===ii,x.type),D)if(F)t.texStorage2D(i.TEXTURE_CUBE_MAP,1,T,J.width,J.height);else for(let X=0;X<6;X++)t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,0,T,J.width,J.height,0,y,M,null)}else if(fe){F&&D&&t.texStorage2D(i.TEXTURE_CUBE_MAP,q,T,J.width,J.height);for(let X=0;X<6;X++){Q=re[X].mipmaps;for(let be=0;be<Q.length;be++){let xe=Q[be];x.format!==Sn?y!==null?F?L&&t.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be,0,0,xe.width,xe.height,y,xe.data):t.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be,T,xe.width,xe.height,0,xe.data):De("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):F?L&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be,0,0,xe.width,xe.height,y,M,xe.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be,T,xe.width,xe.height,0,y,M,xe.data)}}}else{if(Q=x.mipmaps,F&&D){Q.length>0&&q++;let X=Ue(re[0]);t.texStorage2D(i.TEXTURE_CUBE_MAP,q,T,X.width,X.height)}for(let X=0;X<6;X++)if(I){F?L&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,0,0,0,re[X].width,re[X].height,y,M,re[X].data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,0,T,re[X].width,re[X].height,0,y,M,re[X].data);for(let be=0;be<Q.length;be++){let He=Q[be].image[X].image;F?L&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be+1,0,0,He.width,He.height,y,M,He.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be+1,T,He.width,He.height,0,y,M,He.data)}}else{F?L&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,0,0,0,y,M,re[X]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,0,T,y,M,re[X]);for(let be=0;be<Q.length;be++){let xe=Q[be];F?L&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be+1,0,0,y,M,xe.image[X]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+X,be+1,T,y,M,xe.image[X])}}}C(x)&&x.mipmapsAutoUpdate===!0&&E(i.TEXTURE_CUBE_MAP),ue.__version=ae.version,x.onUpdate&&x.onUpdate(x)}A.__version=x.version}function ut(A,x,G,ce,ae,ue){let de=r.convert(G.format,G.colorSpace),ee=r.convert(G.type),ne=R(G.internalFormat,de,ee,G.normalized,G.colorSpace),fe=n.get(x),I=n.get(G);if(I.__renderTarget=x,!fe.__hasExternalTextures){let re=Math.max(1,x.width>>ue),J=Math.max(1,x.height>>ue);ae===i.TEXTURE_3D||ae===i.TEXTURE_2D_ARRAY?t.texImage3D(ae,ue,ne,re,J,x.depth,0,de,ee,null):t.texImage2D(ae,ue,ne,re,J,0,de,ee,null)}t.bindFramebuffer(i.FRAMEBUFFER,A),ge(x)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,ce,ae,I.__webglTexture,0,lt(x)):(ae===i.TEXTURE_2D||ae>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&ae<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,ce,ae,I.__webglTexture,ue),t.bindFramebuffer(i.FRAMEBUFFER,null)}function un(A,x,G){if(i.bindRenderbuffer(i.RENDERBUFFER,A),x.depthBuffer){let ce=x.depthTexture,ae=ce&&ce.isDepthTexture?ce.type:null,ue=_(x.stencilBuffer,ae),de=x.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;ge(x)?o.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,lt(x),ue,x.width,x.height):G?i.renderbufferStorageMultisample(i.RENDERBUFFER,lt(x),ue,x.width,x.height):i.renderbufferStorage(i.RENDERBUFFER,ue,x.width,x.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,de,i.RENDERBUFFER,A)}else{let ce=x.textures;for(let ae=0;ae<ce.length;ae++){let ue=ce[ae],de=r.convert(ue.format,ue.colorSpace),ee=r.convert(ue.type),ne=R(ue.internalFormat,de,ee,ue.normalized,ue.colorSpace);ge(x)?o.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,lt(x),ne,x.width,x.height):G?i.renderbufferStorageMultisample(i.RENDERBUFFER,lt(x),ne,x.width,x.height):i.renderbufferStorage(i.RENDERBUFFER,ne,x.width,x.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function Mt(A,x,G){let ce=x.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(i.FRAMEBUFFER,A),!(x.depthTexture&&x.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let ae=n.get(x.depthTexture);ae.__renderTarget=x;let ue=ce?x.depthTexture.image[0]:x.depthTexture.image;(!ae.__webglTexture||ue.width!==x.width||ue.height!==x.height)&&(ue.width=x.width,ue.height=x.height,x.depthTexture.needsUpdate=!0),ce?_e(x.depthTexture,0):ye(x.depthTexture,0);let de=ae.__webglTexture,ee=lt(x),ne=ce?i.TEXTURE_CUBE_MAP_POSITIVE_X+G:i.TEXTURE_2D,fe=x.depthTexture.format===ii?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(x.depthTexture.format===Qn)ge(x)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,fe,ne,de,0,ee):i.framebufferTexture2D(i.FRAMEBUFFER,fe,ne,de,0);else if(x.depthTexture.format===ii)ge(x)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,fe,ne,de,0,ee):i.framebufferTexture2D(i.FRAMEBUFFER,fe,ne,de,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function Yt(A){let x=n.get(A),G=A.isWebGLCubeRenderTarget===!0;if(x.__boundDepthTexture!==A.depthTexture){let ce=A.depthTexture;if(x.__depthDisposeCallback&&x.__depthDisposeCallback(),ce){let ae=()=>{delete x.__boundDepthTexture,delete x.__depthDisposeCallback,ce.removeEventListener("dispose",ae)};ce.addEventListener("dispose",ae),x.__depthDisposeCallback=ae}x.__boundDepthTexture=ce}if(A.depthTexture&&!x.__autoAllocateDepthBuffer)if(G)for(let ce=0;ce<6;ce++)Mt(x.__webglFramebuffer[ce],A,ce);else A.texture.mipmaps.length>0?Mt(x.__webglFramebuffer[0],A,0):Mt(x.__webglFramebuffer,A,0);else if(G){x.__webglDepthbuffer=[];for(let ce=0;ce<6;ce++)if(t.bindFramebuffer(i.FRAMEBUFFER,x.__webglFramebuffer[ce]),x.__webglDepthbuffer[ce]===void 0)x.__webglDepthbuffer[ce]=i.createRenderbuffer(),un(x.__webglDepthbuffer[ce],A,!1);else{let ae=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,ue=x.__webglDepthbuffer[ce];i.bindRenderbuffer(i.RENDERBUFFER,ue),i.framebufferRenderbuffer(i.FRAMEBUFFER,ae,i.RENDERBUFFER,ue)}}else if(A.texture.mipmaps.length>0?t.bindFramebuffer(i.FRAMEBUFFER,x.__webglFramebuffer[0]):t.bindFramebuffer(i.FRAMEBUFFER,x.__webglFramebuffer),x.__webglDepthbuffer===void 0)x.__webglDepthbuffer=i.createRenderbuffer(),un(x.__webglDepthbuffer,A,!1);else{let ae=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,ue=x.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,ue),i.framebufferRenderbuffer(i.FRAMEBUFFER,ae,i.RENDERBUFFER,ue)}t.bindFramebuffer(i.FRAMEBUFFER,null)}function $t(A,x,G){let ce=n.get(A);x!==void 0&&ut(ce.__webglFramebuffer,A,A.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),G!==void 0&&Yt(A)}function Zt(A){let x=A.texture,G=n.get(A),ce=n.get(x);A.addEventListener("dispose",$),H(A);let ae=A.textures,ue=A.isWebGLCubeRenderTarget===!0,de=ae.length>1;if(de||(ce.__webglTexture===void 0&&(ce.__webglTexture=i.createTexture()),ce.__version=x.version,a.memory.textures++),ue){G.__webglFramebuffer=[];for(let ee=0;ee<6;ee++)if(x.mipmaps.length>0){G.__webglFramebuffer[ee]=[];for(let ne=0;ne<x.mipmaps.length;ne++)G.__webglFramebuffer[ee][ne]=i.createFramebuffer()}else G.__webglFramebuffer[ee]=i.createFramebuffer()}else{if(x.mipmaps.length>0){G.__webglFramebuffer=[];for(let ee=0;ee<x.mipmaps.length;ee++)G.__webglFramebuffer[ee]=i.createFramebuffer()}else G.__webglFramebuffer=i.createFramebuffer();if(de)for(let ee=0,ne=ae.length;ee<ne;ee++){let fe=n.get(ae[ee]);fe.__webglTexture===void 0&&(fe.__webglTexture=i.createTexture(),a.memory.textures++)}if(A.samples>0&&ge(A)===!1){G.__webglMultisampledFramebuffer=i.createFramebuffer(),G.__webglColorRenderbuffer=[],t.bindFramebuffer(i.FRAMEBUFFER,G.__webglMultisampledFramebuffer);for(let ee=0;ee<ae.length;ee++){let ne=ae[ee];G.__webglColorRenderbuffer[ee]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,G.__webglColorRenderbuffer[ee]);let fe=r.convert(ne.format,ne.colorSpace),I=r.convert(ne.type),re=R(ne.internalFormat,fe,I,ne.normalized,ne.colorSpace,A.isXRRenderTarget===!0),J=lt(A);i.renderbufferStorageMultisample(i.RENDERBUFFER,J,re,A.width,A.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+ee,i.RENDERBUFFER,G.__webglColorRenderbuffer[ee])}i.bindRenderbuffer(i.RENDERBUFFER,null),A.depthBuffer&&(G.__webglDepthRenderbuffer=i.createRenderbuffer(),un(G.__webglDepthRenderbuffer,A,!0)),t.bindFramebuffer(i.FRAMEBUFFER,null)}}if(ue){t.bindTexture(i.TEXTURE_CUBE_MAP,ce.__webglTexture),Ke(i.TEXTURE_CUBE_MAP,x);for(let ee=0;ee<6;ee++)if(x.mipmaps.length>0)for(let ne=0;ne<x.mipmaps.length;ne++)ut(G.__webglFramebuffer[ee][ne],A,x,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+ee,ne);else ut(G.__webglFramebuffer[ee],A,x,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+ee,0);C(x)?E(i.TEXTURE_CUBE_MAP):x.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,x.mipmaps.length-1),t.unbindTexture()}else if(de){for(let ee=0,ne=ae.length;ee<ne;ee++){let fe=ae[ee],I=n.get(fe),re=i.TEXTURE_2D;(A.isWebGL3DRenderTarget||A.isWebGLArrayRenderTarget)&&(re=A.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(re,I.__webglTexture),Ke(re,fe),ut(G.__webglFramebuffer,A,fe,i.COLOR_ATTACHMENT0+ee,re,0),C(fe)&&E(re)}t.unbindTexture()}else{let ee=i.TEXTURE_2D;if((A.isWebGL3DRenderTarget||A.isWebGLArrayRenderTarget)&&(ee=A.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(ee,ce.__webglTexture),Ke(ee,x),x.mipmaps.length>0)for(let ne=0;ne<x.mipmaps.length;ne++)ut(G.__webglFramebuffer[ne],A,x,i.COLOR_ATTACHMENT0,ee,ne);else ut(G.__webglFramebuffer,A,x,i.COLOR_ATTACHMENT0,ee,0);C(x)?E(ee):x.mipmaps.length>0&&i.texParameteri(ee,i.TEXTURE_MAX_LEVEL,x.mipmaps.length-1),t.unbindTexture()}A.depthBuffer&&Yt(A)}function B(A){let x=A.textures;for(let G=0,ce=x.length;G<ce;G++){let ae=x[G];if(C(ae)&&ae.mipmapsAutoUpdate===!0){let ue=P(A),de=n.get(ae).__webglTexture;t.bindTexture(ue,de),E(ue),t.unbindTexture()}}}let Kt=[];function rt(A){if(A.samples>0){if(ge(A)===!1){let x=A.textures,G=A.width,ce=A.height,ae=i.COLOR_BUFFER_BIT,ue=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,de=n.get(A),ee=x.length>1;if(ee)for(let fe=0;fe<x.length;fe++)t.bindFramebuffer(i.FRAMEBUFFER,de.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.RENDERBUFFER,null),t.bindFramebuffer(i.FRAMEBUFFER,de.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.TEXTURE_2D,null,0);t.bindFramebuffer(i.READ_FRAMEBUFFER,de.__webglMultisampledFramebuffer),A.texture.mipmaps.length>0?t.bindFramebuffer(i.DRAW_FRAMEBUFFER,de.__webglFramebuffer[0]):t.bindFramebuffer(i.DRAW_FRAMEBUFFER,de.__webglFramebuffer);for(let fe=0;fe<x.length;fe++){if(A.resolveDepthBuffer&&(A.depthBuffer&&(ae|=i.DEPTH_BUFFER_BIT),A.stencilBuffer&&A.resolveStencilBuffer&&(ae|=i.STENCIL_BUFFER_BIT)),ee){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,de.__webglColorRenderbuffer[fe]);let I=n.get(x[fe]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,I,0)}i.blitFramebuffer(0,0,G,ce,0,0,G,ce,ae,i.NEAREST),l===!0&&(Kt.length=0,Kt.push(i.COLOR_ATTACHMENT0+fe),A.depthBuffer&&A.storeMultisampledDepthBuffer===!1&&Kt.push(ue),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,Kt))}if(t.bindFramebuffer(i.READ_FRAMEBUFFER,null),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),ee)for(let fe=0;fe<x.length;fe++){t.bindFramebuffer(i.FRAMEBUFFER,de.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.RENDERBUFFER,de.__webglColorRenderbuffer[fe]);let I=n.get(x[fe]).__webglTexture;t.bindFramebuffer(i.FRAMEBUFFER,de.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.TEXTURE_2D,I,0)}t.bindFramebuffer(i.DRAW_FRAMEBUFFER,de.__webglMultisampledFramebuffer)}else if(A.depthBuffer&&A.storeMultisampledDepthBuffer===!1&&l){let x=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[x])}}}function lt(A){return Math.min(s.maxSamples,A.samples)}function ge(A){let x=n.get(A);return A.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&x.__useRenderToTexture!==!1}function xt(A){let x=a.render.frame;h.get(A)!==x&&(h.set(A,x),A.update())}function Ie(A,x){let G=A.colorSpace,ce=A.format,ae=A.type;return A.isCompressedTexture===!0||A.isVideoTexture===!0||G!==Ys&&G!==wn&&(Ze.getTransfer(G)===it?(ce!==Sn||ae!==jt)&&De("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Fe("WebGLTextures: Unsupported texture color space:",G)),x}function Ue(A){return typeof HTMLImageElement<"u"&&A instanceof HTMLImageElement?(c.width=A.naturalWidth||A.width,c.height=A.naturalHeight||A.height):typeof VideoFrame<"u"&&A instanceof VideoFrame?(c.width=A.displayWidth,c.height=A.displayHeight):(c.width=A.width,c.height=A.height),c}this.allocateTextureUnit=Ne,this.resetTextureUnits=oe,this.getTextureUnits=le,this.setTextureUnits=Re,this.setTexture2D=ye,this.setTexture2DArray=Se,this.setTexture3D=Le,this.setTextureCube=_e,this.rebindTextures=$t,this.setupRenderTarget=Zt,this.updateRenderTargetMipmap=B,this.updateMultisampleRenderTarget=rt,this.setupDepthRenderbuffer=Yt,this.setupFrameBufferTexture=ut,this.useMultisampledRTT=ge,this.dispose=j}function N_(i,e){function t(n,s=wn){let r,a=Ze.getTransfer(s);if(n===jt)return i.UNSIGNED_BYTE;if(n===Ka)return i.UNSIGNED_SHORT_4_4_4_4;if(n===Ja)return i.UNSIGNED_SHORT_5_5_5_1;if(n===rc)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===ac)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===ic)return i.BYTE;if(n===sc)return i.SHORT;if(n===Ts)return i.UNSIGNED_SHORT;if(n===Za)return i.INT;if(n===bn)return i.UNSIGNED_INT;if(n===Mn)return i.FLOAT;if(n===hn)return i.HALF_FLOAT;if(n===oc)return i.ALPHA;if(n===lc)return i.RGB;if(n===Sn)return i.RGBA;if(n===Qn)return i.DEPTH_COMPONENT;if(n===ii)return i.DEPTH_STENCIL;if(n===cc)return i.RED;if(n===ja)return i.RED_INTEGER;if(n===bi)return i.RG;if(n===Qa)return i.RG_INTEGER;if(n===eo)return i.RGBA_INTEGER;if(n===mr||n===gr||n===yr||n===_r)if(a===it)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===mr)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===gr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===yr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===_r)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===mr)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===gr)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===yr)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===_r)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===to||n===no||n===io||n===so)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===to)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===no)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===io)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===so)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===ro||n===ao||n===oo||n===lo||n===co||n===xr||n===ho)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(n===ro||n===ao)return a===it?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===oo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===lo)return r.COMPRESSED_R11_EAC;if(n===co)return r.COMPRESSED_SIGNED_R11_EAC;if(n===xr)return r.COMPRESSED_RG11_EAC;if(n===ho)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===uo||n===fo||n===po||n===mo||n===go||n===yo||n===_o||n===xo||n===vo||n===bo||n===Mo||n===So||n===wo||n===Eo)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(n===uo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===fo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===po)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===mo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===go)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===yo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===_o)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===xo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===vo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===bo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===Mo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===So)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===wo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Eo)return a===it?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===Ao||n===To||n===Ro)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(n===Ao)return a===it?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===To)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Ro)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===Co||n===Po||n===vr||n===Io)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(n===Co)return r.COMPRESSED_RED_RGTC1_EXT;if(n===Po)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===vr)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===Io)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Hi?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:t}}var U_=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,F_=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,Pc=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new sr(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new Nn({vertexShader:U_,fragmentShader:F_,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Gt(new Bi(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Ic=class extends rn{constructor(e,t){super();let n=this,s=null,r=1,a=null,o="local-floor",l=1,c=null,h=null,d=null,u=null,f=null,g=null,b=typeof XRWebGLBinding<"u",p=new Pc,m={},S=t.getContextAttributes(),C=null,E=null,P=[],R=[],_=new Oe,w=null,H=null,O=new Wt;O.viewport=new mt;let z=new Wt;z.viewport=new mt;let $=[O,z],te=new qa,U=null,j=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(se){let ye=P[se];return ye===void 0&&(ye=new _s,P[se]=ye),ye.getTargetRaySpace()},this.getControllerGrip=function(se){let ye=P[se];return ye===void 0&&(ye=new _s,P[se]=ye),ye.getGripSpace()},this.getHand=function(se){let ye=P[se];return ye===void 0&&(ye=new _s,P[se]=ye),ye.getHandSpace()};function ie(se){let ye=R.indexOf(se.inputSource);if(ye===-1)return;let Se=P[ye];Se!==void 0&&(Se.update(se.inputSource,se.frame,c||a),Se.dispatchEvent({type:se.type,data:se.inputSource}))}function Z(){s.removeEventListener("select",ie),s.removeEventListener("selectstart",ie),s.removeEventListener("selectend",ie),s.removeEventListener("squeeze",ie),s.removeEventListener("squeezestart",ie),s.removeEventListener("squeezeend",ie),s.removeEventListener("end",Z),s.removeEventListener("inputsourceschange",he);for(let se=0;se<P.length;se++){let ye=R[se];ye!==null&&(R[se]=null,P[se].disconnect(ye))}U=null,j=null,p.reset();for(let se in m)delete m[se];if(e.setRenderTarget(C),f=null,u=null,d=null,s=null,E=null,Ne.stop(),n.isPresenting=!1,e.setPixelRatio(w),e.setSize(_.width,_.height,!1),H!==null){let se=H.camera;se.fov=H.fov,se.zoom=H.zoom,se.updateProjectionMatrix(),H=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(se){r=se,n.isPresenting===!0&&De("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(se){o=se,n.isPresenting===!0&&De("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(se){c=se},this.getBaseLayer=function(){return u!==null?u:f},this.getBinding=function(){return d===null&&b&&(d=new XRWebGLBinding(s,t)),d},this.getFrame=function(){return g},this.getSession=function(){return s},this.setSession=async function(se){if(s=se,s!==null){if(C=e.getRenderTarget(),s.addEventListener("select",ie),s.addEventListener("selectstart",ie),s.addEventListener("selectend",ie),s.addEventListener("squeeze",ie),s.addEventListener("squeezestart",ie),s.addEventListener("squeezeend",ie),s.addEventListener("end",Z),s.addEventListener("inputsourceschange",he),S.xrCompatible!==!0&&await t.makeXRCompatible(),w=e.getPixelRatio(),e.getSize(_),b&&"createProjectionLayer"in XRWebGLBinding.prototype){let Se=null,Le=null,_e=null;S.depth&&(_e=S.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,Se=S.stencil?ii:Qn,Le=S.stencil?Hi:bn);let Be={colorFormat:t.RGBA8,depthFormat:_e,scaleFactor:r};d=this.getBinding(),u=d.createProjectionLayer(Be),s.updateRenderState({layers:[u]}),e.setPixelRatio(1),e.setSize(u.textureWidth,u.textureHeight,!1),E=new on(u.textureWidth,u.textureHeight,{format:Sn,type:jt,depthTexture:new ti(u.textureWidth,u.textureHeight,Le,void 0,void 0,void 0,void 0,void 0,void 0,Se),stencilBuffer:S.stencil,colorSpace:e.outputColorSpace,samples:S.antialias?4:0,resolveDepthBuffer:u.ignoreDepthValues===!1,resolveStencilBuffer:u.ignoreDepthValues===!1,storeMultisampledDepthBuffer:u.ignoreDepthValues===!1,storeMultisampledStencilBuffer:u.ignoreDepthValues===!1})}else{let Se={antialias:S.antialias,alpha:!0,depth:S.depth,stencil:S.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,t,Se),s.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),E=new on(f.framebufferWidth,f.framebufferHeight,{format:Sn,type:jt,colorSpace:e.outputColorSpace,stencilBuffer:S.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}E.isXRRenderTarget=!0,this.setFoveation(l),c=null,a=await s.requestReferenceSpace(o),Ne.setContext(s),Ne.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return p.getDepthTexture()};function he(se){for(let ye=0;ye<se.removed.length;ye++){let Se=se.removed[ye],Le=R.indexOf(Se);Le>=0&&(R[Le]=null,P[Le].disconnect(Se))}for(let ye=0;ye<se.added.length;ye++){let Se=se.added[ye],Le=R.indexOf(Se);if(Le===-1){for(let Be=0;Be<P.length;Be++)if(Be>=R.length){R.push(Se),Le=Be;break}else if(R[Be]===null){R[Be]=Se,Le=Be;break}if(Le===-1)break}let _e=P[Le];_e&&_e.connect(Se)}}function K(se,ye){ye===null?se.matrixWorld.copy(se.matrix):se.matrixWorld.multiplyMatrices(ye.matrixWorld,se.matrix),se.matrixWorldInverse.copy(se.matrixWorld).invert()}this.updateCamera=function(se){if(s===null)return;let ye=se.near,Se=se.far;p.texture!==null&&(p.depthNear>0&&(ye=p.depthNear),p.depthFar>0&&(Se=p.depthFar)),te.near=z.near=O.near=ye,te.far=z.far=O.far=Se,(U!==te.near||j!==te.far)&&(s.updateRenderState({depthNear:te.near,depthFar:te.far}),U=te.near,j=te.far),te.layers.mask=se.layers.mask|6,O.layers.mask=te.layers.mask&-5,z.layers.mask=te.layers.mask&-3;let Le=se.parent,_e=te.cameras;K(te,Le);for(let Be=0;Be<_e.length;Be++)K(_e[Be],Le);te.projectionMatrix.copy(O.projectionMatrix),te.projectionMatrixInverse.copy(O.projectionMatrixInverse),H===null&&se.isPerspectiveCamera&&(H={camera:se,fov:se.fov,zoom:se.zoom}),oe(se,te,Le)};function oe(se,ye,Se){Se===null?se.matrix.copy(ye.matrixWorld):(se.matrix.copy(Se.matrixWorld),se.matrix.invert(),se.matrix.multiply(ye.matrixWorld)),se.matrix.decompose(se.position,se.quaternion,se.scale),se.updateMatrixWorld(!0),se.projectionMatrix.copy(ye.projectionMatrix),se.projectionMatrixInverse.copy(ye.projectionMatrixInverse),se.isPerspectiveCamera&&(se.fov=gs*2*Math.atan(1/se.projectionMatrix.elements[5]),se.zoom=1)}this.getCamera=function(){return te},this.getFoveation=function(){if(!(u===null&&f===null))return l},this.setFoveation=function(se){l=se,u!==null&&(u.fixedFoveation=se),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=se)},this.hasDepthSensing=function(){return p.texture!==null},this.getDepthSensingMesh=function(){return p.getMesh(te)},this.getCameraTexture=function(se){return m[se]};let le=null;function Re(se,ye){if(h=ye.getViewerPose(c||a),g=ye,h!==null){let Se=h.views;f!==null&&(e.setRenderTargetFramebuffer(E,f.framebuffer),e.setRenderTarget(E));let Le=!1;Se.length!==te.cameras.length&&(te.cameras.length=0,Le=!0);for(let Pe=0;Pe<Se.length;Pe++){let Ke=Se[Pe],Qe=null;if(f!==null)Qe=f.getViewport(Ke);else{let At=d.getViewSubImage(u,Ke);Qe=At.viewport,Pe===0&&(e.setRenderTargetTextures(E,At.colorTexture,At.depthStencilTexture),e.setRenderTarget(E))}let qe=$[Pe];qe===void 0&&(qe=new Wt,qe.layers.enable(Pe),qe.viewport=new mt,$[Pe]=qe),qe.matrix.fromArray(Ke.transform.matrix),qe.matrix.decompose(qe.position,qe.quaternion,qe.scale),qe.projectionMatrix.fromArray(Ke.projectionMatrix),qe.projectionMatrixInverse.copy(qe.projectionMatrix).invert(),qe.viewport.set(Qe.x,Qe.y,Qe.width,Qe.height),Pe===0&&(te.matrix.copy(qe.matrix),te.matrix.decompose(te.position,te.quaternion,te.scale)),Le===!0&&te.cameras.push(qe)}let _e=s.enabledFeatures;if(_e&&_e.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&b){d=n.getBinding();let Pe=d.getDepthInformation(Se[0]);Pe&&Pe.isValid&&Pe.texture&&p.init(Pe,s.renderState)}if(_e&&_e.includes("camera-access")&&b){e.state.unbindTexture(),d=n.getBinding();for(let Pe=0;Pe<Se.length;Pe++){let Ke=Se[Pe].camera;if(Ke){let Qe=m[Ke];Qe||(Qe=new sr,m[Ke]=Qe);let qe=d.getCameraImage(Ke);Qe.sourceTexture=qe}}}}for(let Se=0;Se<P.length;Se++){let Le=R[Se],_e=P[Se];Le!==null&&_e!==void 0&&_e.update(Le,ye,c||a)}le&&le(se,ye),ye.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:ye}),g=null}let Ne=new _d;Ne.setAnimationLoop(Re),this.setAnimationLoop=function(se){le=se},this.dispose=function(){}}},O_=new ht,Rd=new ke;Rd.set(-1,0,0,0,1,0,0,0,1);function B_(i,e){function t(p,m){p.matrixAutoUpdate===!0&&p.updateMatrix(),m.value.copy(p.matrix)}function n(p,m){m.color.getRGB(p.fogColor.value,_c(i)),m.isFog?(p.fogNear.value=m.near,p.fogFar.value=m.far):m.isFogExp2&&(p.fogDensity.value=m.density)}function s(p,m,S,C,E){m.isNodeMaterial?m.uniformsNeedUpdate=!1:m.isMeshBasicMaterial?r(p,m):m.isMeshLambertMaterial?(r(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshToonMaterial?(r(p,m),d(p,m)):m.isMeshPhongMaterial?(r(p,m),h(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshStandardMaterial?(r(p,m),u(p,m),m.isMeshPhysicalMaterial&&f(p,m,E)):m.isMeshMatcapMaterial?(r(p,m),g(p,m)):m.isMeshDepthMaterial?r(p,m):m.isMeshDistanceMaterial?(r(p,m),b(p,m)):m.isMeshNormalMaterial?r(p,m):m.isLineBasicMaterial?(a(p,m),m.isLineDashedMaterial&&o(p,m)):m.isPointsMaterial?l(p,m,S,C):m.isSpriteMaterial?c(p,m):m.isShadowMaterial?(p.color.value.copy(m.color),p.opacity.value=m.opacity):m.isShaderMaterial&&(m.uniformsNeedUpdate=!1)}function r(p,m){p.opacity.value=m.opacity,m.color&&p.diffuse.value.copy(m.color),m.emissive&&p.emissive.value.copy(m.emissive).multiplyScalar(m.emissiveIntensity),m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.bumpMap&&(p.bumpMap.value=m.bumpMap,t(m.bumpMap,p.bumpMapTransform),p.bumpScale.value=m.bumpScale,m.side===qt&&(p.bumpScale.value*=-1)),m.normalMap&&(p.normalMap.value=m.normalMap,t(m.normalMap,p.normalMapTransform),p.normalScale.value.copy(m.normalScale),m.side===qt&&p.normalScale.value.negate()),m.displacementMap&&(p.displacementMap.value=m.displacementMap,t(m.displacementMap,p.displacementMapTransform),p.displacementScale.value=m.displacementScale,p.displacementBias.value=m.displacementBias),m.emissiveMap&&(p.emissiveMap.value=m.emissiveMap,t(m.emissiveMap,p.emissiveMapTransform)),m.specularMap&&(p.specularMap.value=m.specularMap,t(m.specularMap,p.specularMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest);let S=e.get(m),C=S.envMap,E=S.envMapRotation;C&&(p.envMap.value=C,p.envMapRotation.value.setFromMatrix4(O_.makeRotationFromEuler(E)).transpose(),C.isCubeTexture&&C.isRenderTargetTexture===!1&&p.envMapRotation.value.premultiply(Rd),p.reflectivity.value=m.reflectivity,p.ior.value=m.ior,p.refractionRatio.value=m.refractionRatio),m.lightMap&&(p.lightMap.value=m.lightMap,p.lightMapIntensity.value=m.lightMapIntensity,t(m.lightMap,p.lightMapTransform)),m.aoMap&&(p.aoMap.value=m.aoMap,p.aoMapIntensity.value=m.aoMapIntensity,t(m.aoMap,p.aoMapTransform))}function a(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform))}function o(p,m){p.dashSize.value=m.dashSize,p.totalSize.value=m.dashSize+m.gapSize,p.scale.value=m.scale}function l(p,m,S,C){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.size.value=m.size*S,p.scale.value=C*.5,m.map&&(p.map.value=m.map,t(m.map,p.uvTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function c(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.rotation.value=m.rotation,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function h(p,m){p.specular.value.copy(m.specular),p.shininess.value=Math.max(m.shininess,1e-4)}function d(p,m){m.gradientMap&&(p.gradientMap.value=m.gradientMap)}function u(p,m){p.metalness.value=m.metalness,m.metalnessMap&&(p.metalnessMap.value=m.metalnessMap,t(m.metalnessMap,p.metalnessMapTransform)),p.roughness.value=m.roughness,m.roughnessMap&&(p.roughnessMap.value=m.roughnessMap,t(m.roughnessMap,p.roughnessMapTransform)),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)}function f(p,m,S){p.ior.value=m.ior,m.diffuseRoughness>0&&(p.diffuseRoughness.value=m.diffuseRoughness,m.diffuseRoughnessMap&&(p.diffuseRoughnessMap.value=m.diffuseRoughnessMap,t(m.diffuseRoughnessMap,p.diffuseRoughnessMapTransform))),m.sheen>0&&(p.sheenColor.value.copy(m.sheenColor).multiplyScalar(m.sheen),p.sheenRoughness.value=m.sheenRoughness,m.sheenColorMap&&(p.sheenColorMap.value=m.sheenColorMap,t(m.sheenColorMap,p.sheenColorMapTransform)),m.sheenRoughnessMap&&(p.sheenRoughnessMap.value=m.sheenRoughnessMap,t(m.sheenRoughnessMap,p.sheenRoughnessMapTransform))),m.clearcoat>0&&(p.clearcoat.value=m.clearcoat,p.clearcoatRoughness.value=m.clearcoatRoughness,m.clearcoatMap&&(p.clearcoatMap.value=m.clearcoatMap,t(m.clearcoatMap,p.clearcoatMapTransform)),m.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=m.clearcoatRoughnessMap,t(m.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),m.clearcoatNormalMap&&(p.clearcoatNormalMap.value=m.clearcoatNormalMap,t(m.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(m.clearcoatNormalScale),m.side===qt&&p.clearcoatNormalScale.value.negate())),m.dispersion>0&&(p.dispersion.value=m.dispersion),m.retroreflectivity>0&&(p.retroreflectivity.value=m.retroreflectivity),m.iridescence>0&&(p.iridescence.value=m.iridescence,p.iridescenceIOR.value=m.iridescenceIOR,p.iridescenceThicknessMinimum.value=m.iridescenceThicknessMinimum,p.iridescenceThicknessMaximum.value=m.iridescenceThicknessMaximum,m.iridescenceMap&&(p.iridescenceMap.value=m.iridescenceMap,t(m.iridescenceMap,p.iridescenceMapTransform)),m.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=m.iridescenceThicknessMap,t(m.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),m.transmission>0&&(p.transmission.value=m.transmission,p.transmissionSamplerMap.value=S.texture,p.transmissionSamplerSize.value.set(S.width,S.height),m.transmissionMap&&(p.transmissionMap.value=m.transmissionMap,t(m.transmissionMap,p.transmissionMapTransform)),p.thickness.value=m.thickness,m.thicknessMap&&(p.thicknessMap.value=m.thicknessMap,t(m.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=m.attenuationDistance,p.attenuationColor.value.copy(m.attenuationColor)),m.anisotropy>0&&(p.anisotropyVector.value.set(m.anisotropy*Math.cos(m.anisotropyRotation),m.anisotropy*Math.sin(m.anisotropyRotation)),m.anisotropyMap&&(p.anisotropyMap.value=m.anisotropyMap,t(m.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=m.specularIntensity,p.specularColor.value.copy(m.specularColor),m.specularColorMap&&(p.specularColorMap.value=m.specularColorMap,t(m.specularColorMap,p.specularColorMapTransform)),m.specularIntensityMap&&(p.specularIntensityMap.value=m.specularIntensityMap,t(m.specularIntensityMap,p.specularIntensityMapTransform))}function g(p,m){m.matcap&&(p.matcap.value=m.matcap)}function b(p,m){let S=e.get(m).light;p.referencePosition.value.setFromMatrixPosition(S.matrixWorld),p.nearDistance.value=S.shadow.camera.near,p.farDistance.value=S.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function k_(i,e,t,n){let s={},r={};function a(S,C){let E=C.program;n.uniformBlockBinding(S,E,s[S.id])}function o(S,C){let E=s[S.id];E===void 0&&(g(S),E=l(S),s[S.id]=E,S.addEventListener("dispose",p));let P=C.program;n.updateUBOMapping(S,P);let R=e.render.frame;r[S.id]!==R&&(c(S),r[S.id]=R)}function l(S){let C=i.createBuffer(),E=S.__size,P=S.usage;return i.bindBuffer(i.UNIFORM_BUFFER,C),i.bufferData(i.UNIFORM_BUFFER,E,P),i.bindBuffer(i.UNIFORM_BUFFER,null),C}function c(S){let C=s[S.id],E=S.uniforms,P=S.__cache;i.bindBuffer(i.UNIFORM_BUFFER,C);for(let R=0,_=E.length;R<_;R++){let w=E[R];if(Array.isArray(w))for(let H=0,O=w.length;H<O;H++)h(w[H],R,H,P);else h(w,R,0,P)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function h(S,C,E,P){if(u(S,C,E,P)===!0){let R=S.__offset,_=S.value;if(Array.isArray(_)){let w=0;for(let H=0;H<_.length;H++){let O=_[H],z=b(O,!0);d(O,S.__data,w),w+=z.storage/Float32Array.BYTES_PER_ELEMENT}}else d(_,S.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,R,S.__data)}}function d(S,C,E){typeof S=="number"||typeof S=="boolean"?C[E]=S:S.isMatrix3?(C[E]=S.elements[0],C[E+1]=S.elements[1],C[E+2]=S.elements[2],C[E+3]=0,C[E+4]=S.elements[3],C[E+5]=S.elements[4],C[E+6]=S.elements[5],C[E+7]=0,C[E+8]=S.elements[6],C[E+9]=S.elements[7],C[E+10]=S.elements[8],C[E+11]=0):ArrayBuffer.isView(S)?C.set(S.subarray(0,C.length-E),E):S.toArray(C,E)}function u(S,C,E,P){let R=S.value,_=C+"_"+E;if(Array.isArray(R)){P[_]===void 0&&(P[_]=[]);let w=P[_],H=!1;for(let O=0;O<R.length;O++)f(R[O],w,O)===!0&&(H=!0);return H}return f(R,P,_)}function f(S,C,E){if(C[E]===void 0)return typeof S=="number"||typeof S=="boolean"?C[E]=S:ArrayBuffer.isView(S)?C[E]=S.slice():C[E]=S.clone(),!0;{let P=C[E];if(typeof S=="number"||typeof S=="boolean"){if(P!==S)return C[E]=S,!0}else{if(ArrayBuffer.isView(S))return!0;if(P.equals(S)===!1)return P.copy(S),!0}}return!1}function g(S){let C=S.uniforms,E=0,P=16;for(let _=0,w=C.length;_<w;_++){let H=Array.isArray(C[_])?C[_]:[C[_]];for(let O=0,z=H.length;O<z;O++){let $=H[O],te=Array.isArray($.value)?$.value:[$.value],U=Array.isArray(C[_])||Array.isArray($.value),j=E;for(let Z=0,he=te.length;Z<he;Z++){let K=te[Z],oe=b(K,U),le=E%P,Re=le%oe.boundary,Ne=le+Re;E+=Re,Ne!==0&&P-Ne<oe.storage&&(E+=P-Ne),Z===0&&(j=E),E+=oe.storage}let ie=$.type==="int"?Int32Array:$.type==="uint"?Uint32Array:Float32Array;$.__data=new ie((E-j)/Float32Array.BYTES_PER_ELEMENT),$.__offset=j}}let R=E%P;return R>0&&(E+=P-R),S.__size=E,S.__cache={},this}function b(S,C){let E={boundary:0,storage:0};return typeof S=="number"||typeof S=="boolean"?(E.boundary=4,E.storage=4):S.isVector2?(E.boundary=8,E.storage=8):S.isVector3||S.isColor?(E.boundary=16,E.storage=12):S.isVector4?(E.boundary=16,E.storage=16):S.isMatrix3?(E.boundary=16,E.storage=48):S.isMatrix4?(E.boundary=16,E.storage=64):S.isTexture?De("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(S)?(E.boundary=16,E.storage=S.byteLength):De("WebGLRenderer: Unsupported uniform value type.",S),C===!0&&(E.boundary=16,E.storage=Math.ceil(E.storage/16)*16),E}function p(S){let C=S.target;C.removeEventListener("dispose",p),i.deleteBuffer(s[C.id]),delete s[C.id],delete r[C.id]}function m(){for(let S in s)i.deleteBuffer(s[S]);s={},r={}}return{bind:a,update:o,dispose:m}}var z_=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),Bn=null;function G_(){return Bn===null&&(Bn=new Oi(z_,16,16,bi,hn),Bn.name="DFG_LUT",Bn.minFilter=Et,Bn.magFilter=Et,Bn.wrapS=In,Bn.wrapT=In,Bn.generateMipmaps=!1,Bn.needsUpdate=!0),Bn}var Uo=class{constructor(e={}){let{canvas:t=Gu(),context:n=null,depth:s=!0,stencil:r=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:d=!1,reversedDepthBuffer:u=!1,outputBufferType:f=jt}=e;this.isWebGLRenderer=!0;let g;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");g=n.getContextAttributes().alpha}else g=a;let b=f,p=new Set([eo,Qa,ja]),m=new Set([jt,bn,Ts,Hi,Ka,Ja]),S=new Uint32Array(4),C=new Int32Array(4),E={textures:[],min:[],max:[],resolution:[]},P=null,R=null,_=[],w=[],H=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=On,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let O=this,z=!1,$=null,te=null,U=null,j=null;this._outputColorSpace=kt;let ie=0,Z=0,he=null,K=-1,oe=null,le=new mt,Re=new mt,Ne=null,se=new Ve(0),ye=0,Se=t.width,Le=t.height,_e=1,Be=null,ot=null,Pe=new mt(0,0,Se,Le),Ke=new mt(0,0,Se,Le),Qe=!1,qe=new mi,At=new Ia,yt=!1,bt=!1,ut=new ht,un=new k,Mt=new mt,Yt={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},$t=!1;function Zt(){return he===null?_e:1}let B=n;function Kt(v,N){return t.getContext(v,N)}let rt,lt,ge,xt,Ie,Ue,A,x,G,ce,ae,ue,de,ee,ne,fe,I,re,J,y,M,T,F;try{let v={alpha:!0,depth:s,stencil:r,antialias:o,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:h,failIfMajorPerformanceCaveat:d};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",q,!1),t.addEventListener("webglcontextrestored",Q,!1),t.addEventListener("webglcontextcreationerror",X,!1),B===null){let N="webgl2";if(B=Kt(N,v),B===null)throw Kt(N)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}D()}catch(v){throw t.removeEventListener("webglcontextlost",q,!1),t.removeEventListener("webglcontextrestored",Q,!1),t.removeEventListener("webglcontextcreationerror",X,!1),Fe("WebGLRenderer: "+v.message),v}function D(){rt=new j0(B),rt.init(),M=new N_(B,rt),lt=new G0(B,rt,e,M),ge=new L_(B,rt),lt.reversedDepthBuffer&&u&&ge.buffers.depth.setReversed(!0),te=B.createFramebuffer(),U=B.createFramebuffer(),j=B.createFramebuffer(),xt=new ty(B),Ie=new __,Ue=new D_(B,rt,ge,Ie,lt,M,xt),A=new J0(O),x=new im(B),T=new k0(B,x),G=new Q0(B,x,xt,T),ce=new iy(B,G,x,T,xt),re=new ny(B,lt,Ue),ne=new V0(Ie),ae=new y_(O,A,rt,lt,T,ne),ue=new B_(O,Ie),de=new v_,ee=new A_(rt),I=new B0(O,A,ge,ce,g,l),fe=new I_(O,ce,lt),F=new k_(B,xt,lt,ge),J=new z0(B,rt,xt),y=new ey(B,rt,xt),xt.programs=ae.programs,O.capabilities=lt,O.extensions=rt,O.properties=Ie,O.renderLists=de,O.shadowMap=fe,O.state=ge,O.info=xt}b!==jt&&(H=new ry(b,t.width,t.height,o,s,r));let L=new Ic(O,B);this.xr=L,this.getContext=function(){return B},this.getContextAttributes=function(){return B.getContextAttributes()},this.forceContextLoss=function(){let v=rt.get("WEBGL_lose_context");v&&v.loseContext()},this.forceContextRestore=function(){let v=rt.get("WEBGL_lose_context");v&&v.restoreContext()},this.getPixelRatio=function(){return _e},this.setPixelRatio=function(v){v!==void 0&&(_e=v,this.setSize(Se,Le,!1))},this.getSize=function(v){return v.set(Se,Le)},this.setSize=function(v,N,Y=!0){if(L.isPresenting){De("WebGLRenderer: Can't change size while VR device is presenting.");return}Se=v,Le=N,t.width=Math.floor(v*_e),t.height=Math.floor(N*_e),Y===!0&&(t.style.width=v+"px",t.style.height=N+"px"),H!==null&&H.setSize(t.width,t.height),this.setViewport(0,0,v,N)},this.getDrawingBufferSize=function(v){return v.set(Se*_e,Le*_e).floor()},this.setDrawingBufferSize=function(v,N,Y){Se=v,Le=N,_e=Y,t.width=Math.floor(v*Y),t.height=Math.floor(N*Y),this.setViewport(0,0,v,N)},this.setEffects=function(v){if(b===jt){Fe("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(v){for(let N=0;N<v.length;N++)if(v[N].isOutputPass===!0){De("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}H.setEffects(v||[])},this.getCurrentViewport=function(v){return v.copy(le)},this.getViewport=function(v){return v.copy(Pe)},this.setViewport=function(v,N,Y,V){v.isVector4?Pe.set(v.x,v.y,v.z,v.w):Pe.set(v,N,Y,V),ge.viewport(le.copy(Pe).multiplyScalar(Zt()).round())},this.getScissor=function(v){return v.copy(Ke)},this.setScissor=function(v,N,Y,V){v.isVector4?Ke.set(v.x,v.y,v.z,v.w):Ke.set(v,N,Y,V),ge.scissor(Re.copy(Ke).multiplyScalar(Zt()).round())},this.getScissorTest=function(){return Qe},this.setScissorTest=function(v){ge.setScissorTest(Qe=v)},this.setOpaqueSort=function(v){Be=v},this.setTransparentSort=function(v){ot=v},this.getClearColor=function(v){return v.copy(I.getClearColor())},this.setClearColor=function(){I.setClearColor(...arguments)},this.getClearAlpha=function(){return I.getClearAlpha()},this.setClearAlpha=function(){I.setClearAlpha(...arguments)},this.clear=function(v=!0,N=!0,Y=!0){let V=0;if(v){let W=!1;if(he!==null){let me=he.texture.format;W=p.has(me)}if(W){let me=he.texture.type,Ee=m.has(me),pe=I.getClearColor(),Me=I.getClearAlpha(),Ce=pe.r,Ge=pe.g,Ye=pe.b;Ee?(S[0]=Ce,S[1]=Ge,S[2]=Ye,S[3]=Me,B.clearBufferuiv(B.COLOR,0,S)):(C[0]=Ce,C[1]=Ge,C[2]=Ye,C[3]=Me,B.clearBufferiv(B.COLOR,0,C))}else V|=B.COLOR_BUFFER_BIT}N&&(V|=B.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),Y&&(V|=B.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),V!==0&&B.clear(V)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(v){v.setRenderer(this),$=v},this.dispose=function(){t.removeEventListener("webglcontextlost",q,!1),t.removeEventListener("webglcontextrestored",Q,!1),t.removeEventListener("webglcontextcreationerror",X,!1),I.dispose(),de.dispose(),ee.dispose(),Ue.dispose(),Ie.dispose(),A.dispose(),ce.dispose(),G.dispose(),T.dispose(),F.dispose(),ae.dispose(),L.dispose(),L.removeEventListener("sessionstart",ft),L.removeEventListener("sessionend",we),et.stop()};function q(v){v.preventDefault(),pc("WebGLRenderer: Context Lost."),z=!0}function Q(){pc("WebGLRenderer: Context Restored."),z=!1;let v=xt.autoReset,N=fe.enabled,Y=fe.autoUpdate,V=fe.needsUpdate,W=fe.type;D(),xt.autoReset=v,fe.enabled=N,fe.autoUpdate=Y,fe.needsUpdate=V,fe.type=W}function X(v){Fe("WebGLRenderer: A WebGL context could not be created. Reason: ",v.statusMessage)}function be(v){let N=v.target;N.removeEventListener("dispose",be),xe(N)}function xe(v){He(v),Ie.remove(v)}function He(v){let N=Ie.get(v).programs;N!==void 0&&(N.forEach(function(Y){ae.releaseProgram(Y)}),v.isShaderMaterial&&ae.releaseShaderCache(v))}this.renderBufferDirect=function(v,N,Y,V,W,me){N===null&&(N=Yt);let Ee=W.isMesh&&W.matrixWorld.determinantAffine()<0,pe=cf(v,N,Y,V,W);ge.setMaterial(V,Ee);let Me=Y.index,Ce=1;if(V.wireframe===!0){if(Me=G.getWireframeAttribute(Y),Me===void 0)return;Ce=2}let Ge=Y.drawRange,Ye=Y.attributes.position,Ae=Ge.start*Ce,$e=(Ge.start+Ge.count)*Ce;me!==null&&(Ae=Math.max(Ae,me.start*Ce),$e=Math.min($e,(me.start+me.count)*Ce)),Me!==null?(Ae=Math.max(Ae,0),$e=Math.min($e,Me.count)):Ye!=null&&(Ae=Math.max(Ae,0),$e=Math.min($e,Ye.count));let St=$e-Ae;if(St<0||St===1/0)return;T.setup(W,V,pe,Y,Me);let ct,at=J;if(Me!==null&&(ct=x.get(Me),at=y,at.setIndex(ct)),W.isMesh)V.wireframe===!0?(ge.setLineWidth(V.wireframeLinewidth*Zt()),at.setMode(B.LINES)):at.setMode(B.TRIANGLES);else if(W.isLine){let Ut=V.linewidth;Ut===void 0&&(Ut=1),ge.setLineWidth(Ut*Zt()),W.isLineSegments?at.setMode(B.LINES):W.isLineLoop?at.setMode(B.LINE_LOOP):at.setMode(B.LINE_STRIP)}else W.isPoints?at.setMode(B.POINTS):W.isSprite&&at.setMode(B.TRIANGLES);if(W.isBatchedMesh)if(rt.get("WEBGL_multi_draw"))at.renderMultiDraw(W._multiDrawStarts,W._multiDrawCounts,W._multiDrawCount);else{let Ut=W._multiDrawStarts,Te=W._multiDrawCounts,Ht=W._multiDrawCount,tt=Me?x.get(Me).bytesPerElement:1,wi=Ie.get(V).currentProgram.getUniforms();for(let Ft=0;Ft<Ht;Ft++)wi.setValue(B,"_gl_DrawID",Ft),at.render(Ut[Ft]/tt,Te[Ft])}else if(W.isInstancedMesh)at.renderInstances(Ae,St,W.count);else if(Y.isInstancedBufferGeometry){let Ut=Y._maxInstanceCount!==void 0?Y._maxInstanceCount:1/0,Te=Math.min(Y.instanceCount,Ut);at.renderInstances(Ae,St,Te)}else at.render(Ae,St)};function st(v,N,Y,V){$!==null&&v.isNodeMaterial&&$.setObject(V,v),yt===!0&&ne.setState(v,Y,!1),v.transparent===!0&&v.side===Jt&&v.forceSinglePass===!1?(v.side=qt,v.needsUpdate=!0,Ns(v,N,V),v.side=Fn,v.needsUpdate=!0,Ns(v,N,V),v.side=Jt):Ns(v,N,V)}this.compile=function(v,N,Y=null){Y===null&&(Y=v),$!==null&&$.renderStart(v,N,Y),R=ee.get(Y),R.init(N),w.push(R),Y.traverseVisible(function(W){W.isLight&&W.layers.test(N.layers)&&(R.pushLight(W),W.castShadow&&R.pushShadow(W))}),v!==Y&&v.traverseVisible(function(W){W.isLight&&W.layers.test(N.layers)&&(R.pushLight(W),W.castShadow&&R.pushShadow(W))}),R.setupLights(),$!==null&&$.updateLights(R.state.lightsArray),bt=this.localClippingEnabled,yt=ne.init(this.clippingPlanes,bt),yt===!0&&ne.setGlobalState(this.clippingPlanes,N),$!==null&&fe.render(R.state.shadowsArray,Y,N);let V=new Set;return v.traverse(function(W){if(!(W.isMesh||W.isPoints||W.isLine||W.isSprite))return;let me=W.material;if(me)if(Array.isArray(me))for(let Ee=0;Ee<me.length;Ee++){let pe=me[Ee];st(pe,Y,N,W),V.add(pe)}else st(me,Y,N,W),V.add(me)}),R=w.pop(),$!==null&&$.renderEnd(),V},this.compileAsync=function(v,N,Y=null){let V=this.compile(v,N,Y);return new Promise(W=>{function me(){if(V.forEach(function(Ee){let Me=Ie.get(Ee).currentProgram;(Me===void 0||Me.isReady())&&V.delete(Ee)}),V.size===0){W(v);return}setTimeout(me,10)}rt.get("KHR_parallel_shader_compile")!==null?me():setTimeout(me,10)})};let dt=null;function Je(v){dt&&dt(v)}function ft(){et.stop()}function we(){et.start()}let et=new _d;et.setAnimationLoop(Je),typeof self<"u"&&et.setContext(self),this.setAnimationLoop=function(v){dt=v,L.setAnimationLoop(v),v===null?et.stop():et.start()},L.addEventListener("sessionstart",ft),L.addEventListener("sessionend",we),this.render=function(v,N){if(N!==void 0&&N.isCamera!==!0){Fe("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(z===!0)return;$!==null&&$.renderStart(v,N);let Y=L.enabled===!0&&L.isPresenting===!0,V=H!==null&&(he===null||Y)&&H.begin(O,he);if(v.matrixWorldAutoUpdate===!0&&v.updateMatrixWorld(),N.parent===null&&N.matrixWorldAutoUpdate===!0&&N.updateMatrixWorld(),L.enabled===!0&&L.isPresenting===!0&&(H===null||H.isCompositing()===!1)&&(L.cameraAutoUpdate===!0&&L.updateCamera(N),N=L.getCamera()),v.isScene===!0&&v.onBeforeRender(O,v,N,he),R=ee.get(v,w.length),R.init(N),R.state.textureUnits=Ue.getTextureUnits(),w.push(R),ut.multiplyMatrices(N.projectionMatrix,N.matrixWorldInverse),N.isArrayCamera?At.setFromArrayCamera(N):qe.setFromProjectionMatrix(ut,fn,N.reversedDepth),bt=this.localClippingEnabled,yt=ne.init(this.clippingPlanes,bt),P=de.get(v,_.length),P.init(),_.push(P),this.info.render.frame++,L.enabled===!0&&L.isPresenting===!0){let Ee=O.xr.getDepthSensingMesh();Ee!==null&&gn(Ee,N,-1/0,O.sortObjects)}gn(v,N,0,O.sortObjects),P.finish(),$!==null&&$.updateLights(R.state.lightsArray),O.sortObjects===!0&&P.sort(Be,ot),$t=L.enabled===!1||L.isPresenting===!1||L.hasDepthSensing()===!1,$t&&I.addToRenderList(P,v),this.info.autoReset===!0&&this.info.reset(),yt===!0&&ne.beginShadows();let W=R.state.shadowsArray;if(fe.render(W,v,N),yt===!0&&ne.endShadows(),(V&&H.hasRenderPass())===!1){let Ee=P.opaque,pe=P.transmissive;if(R.setupLights(),N.isArrayCamera){let Me=N.cameras;if(pe.length>0)for(let Ce=0,Ge=Me.length;Ce<Ge;Ce++){let Ye=Me[Ce];Ds(Ee,pe,v,Ye)}$t&&I.render(v);for(let Ce=0,Ge=Me.length;Ce<Ge;Ce++){let Ye=Me[Ce];Gn(P,v,Ye,Ye.viewport)}}else pe.length>0&&Ds(Ee,pe,v,N),$t&&I.render(v),Gn(P,v,N)}he!==null&&Z===0&&(Ue.updateMultisampleRenderTarget(he),Ue.updateRenderTargetMipmap(he)),V&&H.end(O),v.isScene===!0&&v.onAfterRender(O,v,N),T.resetDefaultState(),K=-1,oe=null,w.pop(),w.length>0?(R=w[w.length-1],Ue.setTextureUnits(R.state.textureUnits),yt===!0&&ne.setGlobalState(O.clippingPlanes,R.state.camera)):R=null,_.pop(),_.length>0?P=_[_.length-1]:P=null,$!==null&&$.renderEnd()};function gn(v,N,Y,V){if(v.visible===!1)return;if(v.layers.test(N.layers)){if(v.isGroup)Y=v.renderOrder;else if(v.isLOD)v.autoUpdate===!0&&v.update(N);else if(v.isLight)R.pushLight(v),v.castShadow&&R.pushShadow(v);else if(v.isSprite){let Ee=N.isArrayCamera?At:qe;if(!v.frustumCulled||v.intersectsFrustum(Ee)){V&&Mt.setFromMatrixPosition(v.matrixWorld).applyMatrix4(ut);let pe=ce.update(v),Me=v.material;Me.visible&&P.push(v,pe,Me,Y,Mt.z,null,N)}}else if(v.isMesh||v.isLine||v.isPoints){let Ee=N.isArrayCamera?At:qe;if(!v.frustumCulled||v.intersectsFrustum(Ee)){let pe=ce.update(v),Me=v.material;if(V&&(v.boundingSphere!==void 0?(v.boundingSphere===null&&v.computeBoundingSphere(),Mt.copy(v.boundingSphere.center)):(pe.boundingSphere===null&&pe.computeBoundingSphere(),Mt.copy(pe.boundingSphere.center)),Mt.applyMatrix4(v.matrixWorld).applyMatrix4(ut)),Array.isArray(Me)){let Ce=pe.groups;for(let Ge=0,Ye=Ce.length;Ge<Ye;Ge++){let Ae=Ce[Ge],$e=Me[Ae.materialIndex];$e&&$e.visible&&P.push(v,pe,$e,Y,Mt.z,Ae,N)}}else Me.visible&&P.push(v,pe,Me,Y,Mt.z,null,N)}}}let me=v.children;for(let Ee=0,pe=me.length;Ee<pe;Ee++)gn(me[Ee],N,Y,V)}function Gn(v,N,Y,V){let{opaque:W,transmissive:me,transparent:Ee}=v;R.setupLightsView(Y),yt===!0&&ne.setGlobalState(O.clippingPlanes,Y),V&&ge.viewport(le.copy(V)),W.length>0&&Si(W,N,Y),me.length>0&&Si(me,N,Y),Ee.length>0&&Si(Ee,N,Y),ge.buffers.depth.setTest(!0),ge.buffers.depth.setMask(!0),ge.buffers.color.setMask(!0),ge.setPolygonOffset(!1)}function Ds(v,N,Y,V){if((Y.isScene===!0?Y.overrideMaterial:null)!==null)return;if(R.state.transmissionRenderTarget[V.id]===void 0){let Ae=rt.has("EXT_color_buffer_half_float")||rt.has("EXT_color_buffer_float");R.state.transmissionRenderTarget[V.id]=new on(1,1,{generateMipmaps:!0,type:Ae?hn:jt,minFilter:ni,samples:Math.max(4,lt.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Ze.workingColorSpace})}let me=R.state.transmissionRenderTarget[V.id],Ee=V.viewport||le;me.setSize(Ee.z*O.transmissionResolutionScale,Ee.w*O.transmissionResolutionScale);let pe=O.getRenderTarget(),Me=O.getActiveCubeFace(),Ce=O.getActiveMipmapLevel();O.setRenderTarget(me),O.getClearColor(se),ye=O.getClearAlpha(),ye<1&&O.setClearColor(16777215,.5),O.clear(),$t&&I.render(Y);let Ge=O.toneMapping;O.toneMapping=On;let Ye=V.viewport;if(V.viewport!==void 0&&(V.viewport=void 0),R.setupLightsView(V),yt===!0&&ne.setGlobalState(O.clippingPlanes,V),Si(v,Y,V),Ue.updateMultisampleRenderTarget(me),Ue.updateRenderTargetMipmap(me),rt.has("WEBGL_multisampled_render_to_texture")===!1){let Ae=!1;for(let $e=0,St=N.length;$e<St;$e++){let ct=N[$e],{object:at,geometry:Ut,material:Te,group:Ht}=ct;if(Te.side===Jt&&at.layers.test(V.layers)){let tt=Te.side;Te.side=qt,Te.needsUpdate=!0,Gc(at,Y,V,Ut,Te,Ht),Te.side=tt,Te.needsUpdate=!0,Ae=!0}}Ae===!0&&(Ue.updateMultisampleRenderTarget(me),Ue.updateRenderTargetMipmap(me))}O.setRenderTarget(pe,Me,Ce),O.setClearColor(se,ye),Ye!==void 0&&(V.viewport=Ye),O.toneMapping=Ge}function Si(v,N,Y){let V=N.isScene===!0?N.overrideMaterial:null;for(let W=0,me=v.length;W<me;W++){let Ee=v[W],{object:pe,geometry:Me,group:Ce}=Ee,Ge=Ee.material;Ge.allowOverride===!0&&V!==null&&(Ge=V),pe.layers.test(Y.layers)&&Gc(pe,N,Y,Me,Ge,Ce)}}function Gc(v,N,Y,V,W,me){$!==null&&W.isNodeMaterial&&$.setObject(v,W),v.onBeforeRender(O,N,Y,V,W,me),v.modelViewMatrix.multiplyMatrices(Y.matrixWorldInverse,v.matrixWorld),v.normalMatrix.getNormalMatrix(v.modelViewMatrix),W.onBeforeRender(O,N,Y,V,v,me),W.transparent===!0&&W.side===Jt&&W.forceSinglePass===!1?(W.side=qt,W.needsUpdate=!0,O.renderBufferDirect(Y,N,V,W,v,me),W.side=Fn,W.needsUpdate=!0,O.renderBufferDirect(Y,N,V,W,v,me),W.side=Jt):O.renderBufferDirect(Y,N,V,W,v,me),v.onAfterRender(O,N,Y,V,W,me)}function Vc(v){let N=0;for(let Y of v)Y.texture!==null&&N++;return N}function Ns(v,N,Y){N.isScene!==!0&&(N=Yt);let V=Ie.get(v),W=R.state.lights,me=R.state.shadowsArray,Ee=W.state.version,pe=ae.getParameters(v,W.state,me,N,Y,R.state.lightProbeGridArray),Me=ae.getProgramCacheKey(pe),Ce=V.programs;V.environment=v.isMeshStandardMaterial||v.isMeshLambertMaterial||v.isMeshPhongMaterial?N.environment:null,V.fog=N.fog;let Ge=v.isMeshStandardMaterial||v.isMeshLambertMaterial&&!v.envMap||v.isMeshPhongMaterial&&!v.envMap;V.envMap=A.get(v.envMap||V.environment,Ge),V.envMapRotation=V.environment!==null&&v.envMap===null?N.environmentRotation:v.envMapRotation,Ce===void 0&&(v.addEventListener("dispose",be),Ce=new Map,V.programs=Ce,V.programVariants=new Map);let Ye=Ce.get(Me);if(Ye!==void 0){if(V.currentProgram===Ye&&V.lightsStateVersion===Ee)return Wc(v,pe),Ye}else pe.uniforms=ae.getUniforms(v),$!==null&&v.isNodeMaterial&&$.build(v,Y,pe),v.onBeforeCompile(pe,O),Ye=ae.acquireProgram(pe,Me),Ce.set(Me,Ye),V.uniforms=pe.uniforms;let Ae=V.uniforms;return(!v.isShaderMaterial&&!v.isRawShaderMaterial||v.clipping===!0)&&(Ae.clippingPlanes=ne.uniform),Wc(v,pe),V.needsLights=uf(v),V.lightsStateVersion=Ee,V.needsLights&&(Ae.ambientLightColor.value=W.state.ambient,Ae.lightProbe.value=W.state.probe,Ae.sunLights.value=W.state.sun,Ae.sunLightShadows.value=W.state.sunShadow,Ae.directionalLights.value=W.state.directional,Ae.directionalLightShadows.value=W.state.directionalShadow,Ae.spotLights.value=W.state.spot,Ae.spotLightShadows.value=W.state.spotShadow,Ae.rectAreaLights.value=W.state.rectArea,Ae.ltc_1.value=W.state.rectAreaLTC1,Ae.ltc_2.value=W.state.rectAreaLTC2,Ae.pointLights.value=W.state.point,Ae.pointLightShadows.value=W.state.pointShadow,Ae.hemisphereLights.value=W.state.hemi,Ae.sunShadowMatrix.value=W.state.sunShadowMatrix,Ae.sunShadowCascade.value=W.state.sunShadowCascade,Ae.directionalShadowMatrix.value=W.state.directionalShadowMatrix,Ae.spotLightMatrix.value=W.state.spotLightMatrix,Ae.spotLightMap.value=W.state.spotLightMap,Ae.pointShadowMatrix.value=W.state.pointShadowMatrix),V.numLightProbeGrids=Vc(R.state.lightProbeGridArray),V.currentProgram=Ye,V.uniformsList=null,Ye}function lf(v,N,Y,V,W){let me=Ie.get(v),Ee=me.currentProgram.id+","+V+","+W,pe=me.programVariants.get(Ee);return pe===void 0?(pe=Ns(v,N,Y),me.programVariants.set(Ee,pe)):(me.currentProgram=pe,me.uniformsList=null,me.outputColorSpace=V,me.toneMapping=W),pe}function Hc(v){if(v.uniformsList===null){let N=v.currentProgram.getUniforms();v.uniformsList=Cs.seqWithValue(N.seq,v.uniforms)}return v.uniformsList}function Wc(v,N){let Y=Ie.get(v);Y.outputColorSpace=N.outputColorSpace,Y.batching=N.batching,Y.batchingColor=N.batchingColor,Y.instancing=N.instancing,Y.instancingColor=N.instancingColor,Y.instancingMorph=N.instancingMorph,Y.skinning=N.skinning,Y.morphTargets=N.morphTargets,Y.morphNormals=N.morphNormals,Y.morphColors=N.morphColors,Y.morphTargetsCount=N.morphTargetsCount,Y.numClippingPlanes=N.numClippingPlanes,Y.numIntersection=N.numClipIntersection,Y.vertexAlphas=N.vertexAlphas,Y.vertexTangents=N.vertexTangents,Y.toneMapping=N.toneMapping}function cf(v,N,Y,V,W){N.isScene!==!0&&(N=Yt),Ue.resetTextureUnits();let me=N.fog,Ee=V.isMeshStandardMaterial||V.isMeshLambertMaterial||V.isMeshPhongMaterial?N.environment:null,pe=he===null?O.outputColorSpace:he.isXRRenderTarget===!0?he.texture.colorSpace:Ze.workingColorSpace,Me=V.isMeshStandardMaterial||V.isMeshLambertMaterial&&!V.envMap||V.isMeshPhongMaterial&&!V.envMap,Ce=A.get(V.envMap||Ee,Me),Ge=V.vertexColors===!0&&!!Y.attributes.color&&Y.attributes.color.itemSize===4,Ye=!!Y.attributes.tangent&&(!!V.normalMap||V.anisotropy>0),Ae=!!Y.morphAttributes.position,$e=!!Y.morphAttributes.normal,St=!!Y.morphAttributes.color,ct=On;V.toneMapped&&(he===null||he.isXRRenderTarget===!0)&&(ct=O.toneMapping);let at=Y.morphAttributes.position||Y.morphAttributes.normal||Y.morphAttributes.color,Ut=at!==void 0?at.length:0,Te=Ie.get(V),Ht=R.state.lights;if(yt===!0&&(bt===!0||v!==oe)){let gt=v===oe&&V.id===K;ne.setState(V,v,gt)}let tt=!1,wi=!1;V.version===Te.__version?Te.needsLights&&Te.lightsStateVersion!==Ht.state.version||W.isBatchedMesh&&Te.batching===!1||!W.isBatchedMesh&&Te.batching===!0||W.isBatchedMesh&&Te.batchingColor===!0&&W._colorsTexture===null||W.isBatchedMesh&&Te.batchingColor===!1&&W._colorsTexture!==null||W.isInstancedMesh&&Te.instancing===!1||!W.isInstancedMesh&&Te.instancing===!0||W.isSkinnedMesh&&Te.skinning===!1||!W.isSkinnedMesh&&Te.skinning===!0||W.isInstancedMesh&&Te.instancingColor===!0&&W.instanceColor===null||W.isInstancedMesh&&Te.instancingColor===!1&&W.instanceColor!==null||W.isInstancedMesh&&Te.instancingMorph===!0&&W.morphTexture===null||W.isInstancedMesh&&Te.instancingMorph===!1&&W.morphTexture!==null||Te.envMap!==Ce||V.fog===!0&&Te.fog!==me||Te.numClippingPlanes!==void 0&&(Te.numClippingPlanes!==ne.numPlanes||Te.numIntersection!==ne.numIntersection)||Te.vertexAlphas!==Ge||Te.vertexTangents!==Ye||Te.morphTargets!==Ae||Te.morphNormals!==$e||Te.morphColors!==St||Te.morphTargetsCount!==Ut||Te.numLightProbeGrids!==Vc(R.state.lightProbeGridArray)?tt=!0:(Te.outputColorSpace!==pe||Te.toneMapping!==ct)&&(wi=!0):(tt=!0,Te.__version=V.version);let Ft=Te.currentProgram;(tt===!0||wi===!0)&&(Ft=wi===!0?lf(V,N,W,pe,ct):Ns(V,N,W),$&&V.isNodeMaterial&&$.onUpdateProgram(V,Ft,Te));let Lr=!1,si=!1,Ei=!1,je=Ft.getUniforms(),Dt=Te.uniforms;if(ge.useProgram(Ft.program)&&(Lr=!0,si=!0,Ei=!0),V.id!==K&&(K=V.id,si=!0),Lr||oe!==v){ge.buffers.depth.getReversed()&&v.reversedDepth!==!0&&(v._reversedDepth=!0,v.updateProjectionMatrix()),je.setValue(B,"projectionMatrix",v.projectionMatrix),je.setValue(B,"viewMatrix",v.matrixWorldInverse);let Pt=je.map.cameraPosition;Pt!==void 0&&Pt.setValue(B,un.setFromMatrixPosition(v.matrixWorld)),lt.logarithmicDepthBuffer&&je.setValue(B,"logDepthBufFC",2/(Math.log(v.far+1)/Math.LN2)),(V.isMeshPhongMaterial||V.isMeshToonMaterial||V.isMeshLambertMaterial||V.isMeshBasicMaterial||V.isMeshStandardMaterial||V.isShaderMaterial)&&je.setValue(B,"isOrthographic",v.isOrthographicCamera===!0),oe!==v&&(oe=v,si=!0,Ei=!0)}if(Te.needsLights&&(Ht.state.sunShadowMap.length>0&&je.setValue(B,"sunShadowMap",Ht.state.sunShadowMap,Ue),Ht.state.directionalShadowMap.length>0&&je.setValue(B,"directionalShadowMap",Ht.state.directionalShadowMap,Ue),Ht.state.spotShadowMap.length>0&&je.setValue(B,"spotShadowMap",Ht.state.spotShadowMap,Ue),Ht.state.pointShadowMap.length>0&&je.setValue(B,"pointShadowMap",Ht.state.pointShadowMap,Ue)),W.isSkinnedMesh){je.setOptional(B,W,"bindMatrix"),je.setOptional(B,W,"bindMatrixInverse");let gt=W.skeleton;gt&&(gt.boneTexture===null&&gt.computeBoneTexture(),je.setValue(B,"boneTexture",gt.boneTexture,Ue))}W.isBatchedMesh&&(je.setOptional(B,W,"batchingTexture"),je.setValue(B,"batchingTexture",W._matricesTexture,Ue),je.setOptional(B,W,"batchingIdTexture"),je.setValue(B,"batchingIdTexture",W._indirectTexture,Ue),je.setOptional(B,W,"batchingColorTexture"),W._colorsTexture!==null&&je.setValue(B,"batchingColorTexture",W._colorsTexture,Ue));let yn=Y.morphAttributes;if((yn.position!==void 0||yn.normal!==void 0||yn.color!==void 0)&&re.update(W,Y,Ft),(si||Te.receiveShadow!==W.receiveShadow)&&(Te.receiveShadow=W.receiveShadow,je.setValue(B,"receiveShadow",W.receiveShadow)),(V.isMeshStandardMaterial||V.isMeshLambertMaterial||V.isMeshPhongMaterial)&&V.envMap===null&&N.environment!==null&&(Dt.envMapIntensity.value=N.environmentIntensity),Dt.dfgLUT!==void 0&&(Dt.dfgLUT.value=G_()),si){if(je.setValue(B,"toneMappingExposure",O.toneMappingExposure),Te.needsLights&&hf(Dt,Ei),me&&V.fog===!0&&ue.refreshFogUniforms(Dt,me),ue.refreshMaterialUniforms(Dt,V,_e,Le,R.state.transmissionRenderTarget[v.id]),Te.needsLights&&Te.numLightProbeGrids>0){let gt=E,Pt=0;for(let Vn of R.state.lightProbeGridArray)Vn.texture!==null&&(gt.textures[Pt]=Vn.texture,gt.min[Pt]=Vn.boundingBox.min,gt.max[Pt]=Vn.boundingBox.max,gt.resolution[Pt]=Vn.resolution,Pt++);for(let Vn in gt)gt[Vn].length=Pt;Dt.probesSH.value=gt.textures,Dt.probesMin.value=gt.min,Dt.probesMax.value=gt.max,Dt.probesResolution.value=gt.resolution}Cs.upload(B,Hc(Te),Dt,Ue)}if(V.isShaderMaterial&&V.uniformsNeedUpdate===!0&&(Cs.upload(B,Hc(Te),Dt,Ue),V.uniformsNeedUpdate=!1),V.isSpriteMaterial&&je.setValue(B,"center",W.center),je.setValue(B,"modelViewMatrix",W.modelViewMatrix),je.setValue(B,"normalMatrix",W.normalMatrix),je.setValue(B,"modelMatrix",W.matrixWorld),V.uniformsGroups!==void 0){let gt=V.uniformsGroups;for(let Pt=0,Vn=gt.length;Pt<Vn;Pt++){let qc=gt[Pt];F.update(qc,Ft),F.bind(qc,Ft)}}return Ft}function hf(v,N){v.ambientLightColor.needsUpdate=N,v.lightProbe.needsUpdate=N,v.sunLights.needsUpdate=N,v.sunLightShadows.needsUpdate=N,v.directionalLights.needsUpdate=N,v.directionalLightShadows.needsUpdate=N,v.pointLights.needsUpdate=N,v.pointLightShadows.needsUpdate=N,v.spotLights.needsUpdate=N,v.spotLightShadows.needsUpdate=N,v.rectAreaLights.needsUpdate=N,v.hemisphereLights.needsUpdate=N}function uf(v){return v.isMeshLambertMaterial||v.isMeshToonMaterial||v.isMeshPhongMaterial||v.isMeshStandardMaterial||v.isShadowMaterial||v.isShaderMaterial&&v.lights===!0}this.getActiveCubeFace=function(){return ie},this.getActiveMipmapLevel=function(){return Z},this.getRenderTarget=function(){return he},this.setRenderTargetTextures=function(v,N,Y){let V=Ie.get(v);V.__autoAllocateDepthBuffer=v.resolveDepthBuffer===!1,V.__autoAllocateDepthBuffer===!1&&(V.__useRenderToTexture=!1),Ie.get(v.texture).__webglTexture=N,Ie.get(v.depthTexture).__webglTexture=V.__autoAllocateDepthBuffer?void 0:Y,V.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(v,N){let Y=Ie.get(v);Y.__webglFramebuffer=N,Y.__useDefaultFramebuffer=N===void 0},this.setRenderTarget=function(v,N=0,Y=0){he=v,ie=N,Z=Y;let V=null,W=!1,me=!1;if(v){let pe=Ie.get(v);if(pe.__useDefaultFramebuffer!==void 0){ge.bindFramebuffer(B.FRAMEBUFFER,pe.__webglFramebuffer),le.copy(v.viewport),Re.copy(v.scissor),Ne=v.scissorTest,ge.viewport(le),ge.scissor(Re),ge.setScissorTest(Ne),K=-1;return}else if(pe.__webglFramebuffer===void 0)Ue.setupRenderTarget(v);else if(pe.__hasExternalTextures)Ue.rebindTextures(v,Ie.get(v.texture).__webglTexture,Ie.get(v.depthTexture).__webglTexture);else if(v.depthBuffer){let Ge=v.depthTexture;if(pe.__boundDepthTexture!==Ge){if(Ge!==null&&Ie.has(Ge)&&(v.width!==Ge.image.width||v.height!==Ge.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Ue.setupDepthRenderbuffer(v)}}let Me=v.texture;(Me.isData3DTexture||Me.isDataArrayTexture||Me.isCompressedArrayTexture)&&(me=!0);let Ce=Ie.get(v).__webglFramebuffer;v.isWebGLCubeRenderTarget?(Array.isArray(Ce[N])?V=Ce[N][Y]:V=Ce[N],W=!0):v.samples>0&&Ue.useMultisampledRTT(v)===!1?V=Ie.get(v).__webglMultisampledFramebuffer:Array.isArray(Ce)?V=Ce[Y]:V=Ce,le.copy(v.viewport),Re.copy(v.scissor),Ne=v.scissorTest}else le.copy(Pe).multiplyScalar(_e).floor(),Re.copy(Ke).multiplyScalar(_e).floor(),Ne=Qe;if(Y!==0&&(V=te),ge.bindFramebuffer(B.FRAMEBUFFER,V)&&ge.drawBuffers(v,V),ge.viewport(le),ge.scissor(Re),ge.setScissorTest(Ne),W){let pe=Ie.get(v.texture);B.framebufferTexture2D(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_CUBE_MAP_POSITIVE_X+N,pe.__webglTexture,Y)}else if(me){let pe=N;for(let Me=0;Me<v.textures.length;Me++){let Ce=Ie.get(v.textures[Me]);B.framebufferTextureLayer(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0+Me,Ce.__webglTexture,Y,pe)}}else if(v!==null&&Y!==0){let pe=Ie.get(v.texture);B.framebufferTexture2D(B.FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,pe.__webglTexture,Y)}K=-1};function Xc(v){let N=Ie.get(v);return(N.__readFormat!==v.format||N.__readType!==v.type)&&(N.__readFormat=v.format,N.__readType=v.type,N.__formatReadable=lt.textureFormatReadable(v.format),N.__typeReadable=lt.textureTypeReadable(v.type)),N}this.readRenderTargetPixels=function(v,N,Y,V,W,me,Ee,pe=0){if(!(v&&v.isWebGLRenderTarget)){Fe("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Me=Ie.get(v).__webglFramebuffer;if(v.isWebGLCubeRenderTarget&&Ee!==void 0&&(Me=Me[Ee],Array.isArray(Me)&&(Me=Me[0])),Me){ge.bindFramebuffer(B.FRAMEBUFFER,Me);try{let Ce=v.textures[pe],Ge=Ce.format,Ye=Ce.type;v.textures.length>1&&B.readBuffer(B.COLOR_ATTACHMENT0+pe);let Ae=Xc(Ce);if(Ae.__formatReadable===!1){Fe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(Ae.__typeReadable===!1){Fe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}N>=0&&N<=v.width-V&&Y>=0&&Y<=v.height-W&&B.readPixels(N,Y,V,W,M.convert(Ge),M.convert(Ye),me)}finally{let Ce=he!==null?Ie.get(he).__webglFramebuffer:null;ge.bindFramebuffer(B.FRAMEBUFFER,Ce)}}},this.readRenderTargetPixelsAsync=async function(v,N,Y,V,W,me,Ee,pe=0){if(!(v&&v.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Me=Ie.get(v).__webglFramebuffer;if(v.isWebGLCubeRenderTarget&&Ee!==void 0&&(Me=Me[Ee],Array.isArray(Me)&&(Me=Me[0])),Me)if(N>=0&&N<=v.width-V&&Y>=0&&Y<=v.height-W){ge.bindFramebuffer(B.FRAMEBUFFER,Me);let Ce=v.textures[pe],Ge=Ce.format,Ye=Ce.type;v.textures.length>1&&B.readBuffer(B.COLOR_ATTACHMENT0+pe);let Ae=Xc(Ce);if(Ae.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(Ae.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let $e=B.createBuffer();B.bindBuffer(B.PIXEL_PACK_BUFFER,$e),B.bufferData(B.PIXEL_PACK_BUFFER,me.byteLength,B.STREAM_READ),B.readPixels(N,Y,V,W,M.convert(Ge),M.convert(Ye),0),B.bindBuffer(B.PIXEL_PACK_BUFFER,null);let St=he!==null?Ie.get(he).__webglFramebuffer:null;ge.bindFramebuffer(B.FRAMEBUFFER,St);let ct=B.fenceSync(B.SYNC_GPU_COMMANDS_COMPLETE,0);return B.flush(),await Hu(B,ct,4),B.bindBuffer(B.PIXEL_PACK_BUFFER,$e),B.getBufferSubData(B.PIXEL_PACK_BUFFER,0,me),B.bindBuffer(B.PIXEL_PACK_BUFFER,null),B.deleteBuffer($e),B.deleteSync(ct),me}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(v,N=null,Y=0){let V=Math.pow(2,-Y),W=Math.floor(v.image.width*V),me=Math.floor(v.image.height*V),Ee=N!==null?N.x:0,pe=N!==null?N.y:0;Ue.setTexture2D(v,0),B.copyTexSubImage2D(B.TEXTURE_2D,Y,0,0,Ee,pe,W,me),ge.unbindTexture()},this.copyTextureToTexture=function(v,N,Y=null,V=null,W=0,me=0){let Ee,pe,Me,Ce,Ge,Ye,Ae,$e,St,ct=v.isCompressedTexture?v.mipmaps[me]:v.image;if(Y!==null)Ee=Y.max.x-Y.min.x,pe=Y.max.y-Y.min.y,Me=Y.isBox3?Y.max.z-Y.min.z:1,Ce=Y.min.x,Ge=Y.min.y,Ye=Y.isBox3?Y.min.z:0;else{let je=Math.pow(2,-W);Ee=Math.floor(ct.width*je),pe=Math.floor(ct.height*je),v.isDataArrayTexture?Me=ct.depth:v.isData3DTexture?Me=Math.floor(ct.depth*je):Me=1,Ce=0,Ge=0,Ye=0}V!==null?(Ae=V.x,$e=V.y,St=V.z):(Ae=0,$e=0,St=0);let at=M.convert(N.format),Ut=M.convert(N.type),Te;N.isData3DTexture?(Ue.setTexture3D(N,0),Te=B.TEXTURE_3D):N.isDataArrayTexture||N.isCompressedArrayTexture?(Ue.setTexture2DArray(N,0),Te=B.TEXTURE_2D_ARRAY):(Ue.setTexture2D(N,0),Te=B.TEXTURE_2D),ge.activeTexture(B.TEXTURE0),ge.pixelStorei(B.UNPACK_FLIP_Y_WEBGL,N.flipY),ge.pixelStorei(B.UNPACK_PREMULTIPLY_ALPHA_WEBGL,N.premultiplyAlpha),ge.pixelStorei(B.UNPACK_ALIGNMENT,N.unpackAlignment);let Ht=ge.getParameter(B.UNPACK_ROW_LENGTH),tt=ge.getParameter(B.UNPACK_IMAGE_HEIGHT),wi=ge.getParameter(B.UNPACK_SKIP_PIXELS),Ft=ge.getParameter(B.UNPACK_SKIP_ROWS),Lr=ge.getParameter(B.UNPACK_SKIP_IMAGES);ge.pixelStorei(B.UNPACK_ROW_LENGTH,ct.width),ge.pixelStorei(B.UNPACK_IMAGE_HEIGHT,ct.height),ge.pixelStorei(B.UNPACK_SKIP_PIXELS,Ce),ge.pixelStorei(B.UNPACK_SKIP_ROWS,Ge),ge.pixelStorei(B.UNPACK_SKIP_IMAGES,Ye);let si=v.isDataArrayTexture||v.isData3DTexture,Ei=N.isDataArrayTexture||N.isData3DTexture;if(v.isDepthTexture){let je=Ie.get(v),Dt=Ie.get(N),yn=Ie.get(je.__renderTarget),gt=Ie.get(Dt.__renderTarget);ge.bindFramebuffer(B.READ_FRAMEBUFFER,yn.__webglFramebuffer),ge.bindFramebuffer(B.DRAW_FRAMEBUFFER,gt.__webglFramebuffer);for(let Pt=0;Pt<Me;Pt++)si&&(B.framebufferTextureLayer(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,Ie.get(v).__webglTexture,W,Ye+Pt),B.framebufferTextureLayer(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,Ie.get(N).__webglTexture,me,St+Pt)),B.blitFramebuffer(Ce,Ge,Ce+Ee,Ge+pe,Ae,$e,Ae+Ee,$e+pe,B.DEPTH_BUFFER_BIT,B.NEAREST);ge.bindFramebuffer(B.READ_FRAMEBUFFER,null),ge.bindFramebuffer(B.DRAW_FRAMEBUFFER,null)}else if(W!==0||v.isRenderTargetTexture||Ie.has(v)){let je=Ie.get(v),Dt=Ie.get(N);ge.bindFramebuffer(B.READ_FRAMEBUFFER,U),ge.bindFramebuffer(B.DRAW_FRAMEBUFFER,j);for(let yn=0;yn<Me;yn++)si?B.framebufferTextureLayer(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,je.__webglTexture,W,Ye+yn):B.framebufferTexture2D(B.READ_FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,je.__webglTexture,W),Ei?B.framebufferTextureLayer(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,Dt.__webglTexture,me,St+yn):B.framebufferTexture2D(B.DRAW_FRAMEBUFFER,B.COLOR_ATTACHMENT0,B.TEXTURE_2D,Dt.__webglTexture,me),W!==0?B.blitFramebuffer(Ce,Ge,Ce+Ee,Ge+pe,Ae,$e,Ae+Ee,$e+pe,B.COLOR_BUFFER_BIT,B.NEAREST):Ei?B.copyTexSubImage3D(Te,me,Ae,$e,St+yn,Ce,Ge,Ee,pe):B.copyTexSubImage2D(Te,me,Ae,$e,Ce,Ge,Ee,pe);ge.bindFramebuffer(B.READ_FRAMEBUFFER,null),ge.bindFramebuffer(B.DRAW_FRAMEBUFFER,null)}else Ei?v.isDataTexture||v.isData3DTexture?B.texSubImage3D(Te,me,Ae,$e,St,Ee,pe,Me,at,Ut,ct.data):N.isCompressedArrayTexture?B.compressedTexSubImage3D(Te,me,Ae,$e,St,Ee,pe,Me,at,ct.data):B.texSubImage3D(Te,me,Ae,$e,St,Ee,pe,Me,at,Ut,ct):v.isDataTexture?B.texSubImage2D(B.TEXTURE_2D,me,Ae,$e,Ee,pe,at,Ut,ct.data):v.isCompressedTexture?B.compressedTexSubImage2D(B.TEXTURE_2D,me,Ae,$e,ct.width,ct.height,at,ct.data):B.texSubImage2D(B.TEXTURE_2D,me,Ae,$e,Ee,pe,at,Ut,ct);ge.pixelStorei(B.UNPACK_ROW_LENGTH,Ht),ge.pixelStorei(B.UNPACK_IMAGE_HEIGHT,tt),ge.pixelStorei(B.UNPACK_SKIP_PIXELS,wi),ge.pixelStorei(B.UNPACK_SKIP_ROWS,Ft),ge.pixelStorei(B.UNPACK_SKIP_IMAGES,Lr),me===0&&N.generateMipmaps===!0&&N.mipmapsAutoUpdate===!0&&B.generateMipmap(Te),ge.unbindTexture()},this.initRenderTarget=function(v){Ie.get(v).__webglFramebuffer===void 0&&Ue.setupRenderTarget(v)},this.initTexture=function(v){v.isCubeTexture?Ue.setTextureCube(v,0):v.isData3DTexture?Ue.setTexture3D(v,0):v.isDataArrayTexture||v.isCompressedArrayTexture?Ue.setTexture2DArray(v,0):Ue.setTexture2D(v,0),ge.unbindTexture()},this.resetState=function(){ie=0,Z=0,he=null,ge.reset(),T.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return fn}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=Ze._getDrawingBufferColorSpace(e),t.unpackColorSpace=Ze._getUnpackColorSpace()}};var Xi=class extends Dn{constructor(t={}){super();this.progress=t;this.metadata=new Map;this.origin=new Int32Array(0);this.refined=new Uint8Array(0);this.refinedVertices=0;this.blocks=0;this.carried=[];this.points=new Float32Array(0);this.pieces=[];this.frames=[];this.shown=-1;this.normals=new Float32Array(0);this.drawn=0}get frameRate(){let t=this.metadata.get("frame_rate");return typeof t=="number"&&t>0&&t<1/0?t:0}accept(t){switch(t.type){case"header":this.header=t.header;return;case"metadata":return t.entries.forEach((n,s)=>this.metadata.set(s,n)),this.progress.onMetadata?.(t.entries,this);case"begun":return this.begin(t);case"grown":return this.grow(t);case"whole":return this.coming=t.shape,t.run===0?this.take(t.shape):void 0;case"attribute":return void this.carried.push(t);case"frame":return this.keep(t);case"loss":return this.lose(t)}}showFrame(t){let{positions:n,normals:s,attributes:r,shape:a}=this.frames[t];if(t===this.shown)return;this.shown=t,a!==this.worn&&this.take(a);let o=this.getAttribute("position");o.array=n,o.needsUpdate=!0;let l=this.getAttribute("normal");l.array instanceof Int16Array||this.setAttribute("normal",l=new vt(s,3,!0)),l.array=s,l.needsUpdate=!0;for(let{name:c,values:h}of r){let d=this.getAttribute(c);d.array=h,d.needsUpdate=!0}}begin({vertices:t,corners:n,loose:s}){this.refuseIfWhole(),this.points=new Float32Array(3*t),this.normals=new Float32Array(3*t),this.origin=new Int32Array(t).fill(-1),this.refined=new Uint8Array(t),s.vertices.forEach((r,a)=>this.points.set(s.positions.subarray(3*a,3*a+3),3*r)),this.setAttribute("position",new vt(this.points,3)),this.setAttribute("normal",new vt(this.normals,3)),this.setIndex(new vt(new Uint32Array(n),1)),this.setDrawRange(0,this.drawn),this.progress.onConnectivity?.(this)}grow({vertices:t,positions:n,normals:s,origin:r,refined:a,index:o,blocks:l}){this.refuseIfWhole();let{points:c,normals:h}=this;for(let u=0;u<t.length;u++){let[f,g]=[3*t[u],3*u];[c[f],c[f+1],c[f+2]]=[n[g],n[g+1],n[g+2]],[h[f],h[f+1],h[f+2]]=[s[g],s[g+1],s[g+2]],this.origin[t[u]]=r[u],this.refinedVertices+=a[u]-this.refined[t[u]],this.refined[t[u]]=a[u]}let d=this.getIndex();d?.array.set(o,this.drawn),this.drawn+=o.length;for(let u of[d,this.getAttribute("position"),this.getAttribute("normal")])u&&(u.needsUpdate=!0);this.setDrawRange(0,this.drawn),[this.boundingBox,this.boundingSphere]=[null,null],this.blocks=l,this.progress.onBlock?.(this)}refuseIfWhole(){if(this.worn)throw new Error("this geometry is whole and cannot grow")}take(t){let{index:n,positions:s,normals:r,attributes:a,vertices:o,pieces:l,center:c,radius:h,low:d,high:u}=t;if(this.getIndex()&&this.dispose(),this.worn)for(let{name:f}of this.worn.attributes)this.deleteAttribute(f);this.worn=t,this.clearGroups(),this.parted=o,this.pieces=l,this.setIndex(new vt(n,1)),this.setAttribute("position",new vt(s,3)),this.setAttribute("normal",new vt(r,3));for(let{name:f,values:g,components:b}of a)this.setAttribute(f,new vt(g,b));this.color=this.attributes.color,this.setDrawRange(0,n.length),l.some(({material:f})=>f>0)&&l.forEach(({start:f,count:g,material:b})=>this.addGroup(f,g,b)),this.boundingBox=new ln(new k(...d),new k(...u)),this.boundingSphere=new fi(new k(...c),h)}keep({index:t,positions:n,normals:s,attributes:r}){this.frames.push({positions:n,normals:s,attributes:r,shape:this.coming}),t===0&&this.showFrame(0),this.progress.onFrame?.(t,this)}lose({frames:t}){let n=this.frames.at(-1);for(let s=0;n&&s<(t?.count??0);s++)this.frames.push(n)}};function Bo(i){let e=i.get("up");return e==="z"?[-Math.PI/2,0,0]:e==="x"?[0,0,Math.PI/2]:[0,0,0]}var V_={baseColorTexture:["map"],map_Kd:["map"],emissiveTexture:["emissiveMap"],map_Ke:["emissiveMap"],normalTexture:["normalMap"],norm:["normalMap"],metallicRoughnessTexture:["metalnessMap","roughnessMap"],occlusionTexture:["aoMap"]},H_=["map","emissiveMap"];async function Pd(i){let e=[...i].flatMap(([n,s])=>{let r=/^image\.(\d+)\.data$/.exec(n);return r&&s instanceof Uint8Array?[[Number(r[1]),s]]:[]}),t=await Promise.all(e.map(async([n,s])=>[n,await W_(s)]));return new Map(t.flatMap(([n,s])=>s?[[n,s]]:[]))}async function W_(i){try{let e=await createImageBitmap(new Blob([i]),{imageOrientation:"flipY",colorSpaceConversion:"none"}),t=new zt(e);return t.flipY=!1,t.wrapS=t.wrapT=fs,t.needsUpdate=!0,t}catch{return}}function Id(i,e,t){let n=Array.from({length:t},()=>new Map);for(let[s,r]of i){let a=/^material\.(\d+)\.(.+)$/s.exec(s);a&&Number(a[1])<t&&(typeof r=="string"||typeof r=="number")&&n[Number(a[1])].set(a[2],r)}return n.map(s=>X_(s,e))}function Cd(i){return String(i??"").split(/\s+/).filter(Boolean).map(Number)}function X_(i,e){let t=!["baseColorFactor","baseColorTexture","metallicFactor","roughnessFactor"].some(d=>i.has(d)),n=new ki({name:String(i.get("name")??""),metalness:t?0:1,roughness:1}),[s=1,r=1,a=1,o=1]=Cd(i.get("baseColorFactor")??i.get("Kd"));i.has("baseColorFactor")?n.color.setRGB(s,r,a):n.color=new Ve().setRGB(s,r,a,kt);let l=Cd(i.get("emissiveFactor")??i.get("Ke"));l.length===3&&n.emissive.setRGB(l[0],l[1],l[2]);for(let[d,u]of[["metallicFactor","metalness"],["Pm","metalness"],["roughnessFactor","roughness"],["Pr","roughness"]])i.has(d)&&(n[u]=Number(i.get(d)));for(let[d,u]of Object.entries(V_)){let f=e.get(Number(i.get(d)??NaN));if(f)for(let g of u)n[g]=q_(f,H_.includes(g))}n.emissiveMap&&l.length===0&&n.emissive.set(16777215);let c=o*Number(i.get("d")??1),h=i.get("alphaMode");return n.opacity=c,n.transparent=h==="BLEND"||h===void 0&&c<1,h==="MASK"&&(n.alphaTest=Number(i.get("alphaCutoff")??.5)),n.side=t||Number(i.get("doubleSided")??0)?Jt:Fn,n}function q_(i,e){let t=e?kt:wn;return i.colorSpace===t||(i.userData.taken&&(i=i.clone(),i.needsUpdate=!0),i.userData.taken=!0,i.colorSpace=t),i}function mn(i){return i.toLocaleString("en")}function ko(i){return i<1e3?`${Math.ceil(i)} ms`:`${(i/1e3).toFixed(2)} s`}function zn(i){let[e,t]=i<1e3?[i,"bytes"]:i<1e7?[i/1e3,"kB"]:[i/1e6,"MB"];return`${e.toLocaleString("en",{maximumFractionDigits:e<100&&t!=="bytes"?1:0})} ${t}`}function Mi(i){return`${Number((100*i).toPrecision(3))} %`}function Ld(i){return i.toLocaleString("en",{maximumFractionDigits:i<10?1:0})}function An(i,e,...t){let n=document.createElement(i);return n.textContent=e,n.append(...t),n}function Y_({look:i,farthest:e,diagonal:t=1},n,s){if(i!==void 0)return`${i<=1?"Looks the same":i<=2?"Close: differences show side by side":"A preview"} (${n})`;if(!e)return e===0?"No difference was measured":"";let r=typeof s=="string"?`${Number((e*t).toPrecision(2))} ${s}`:`${Mi(e)} of the diagonal`;return`${e<=.001?"Close: differences":"Differences"} up to ${r}`}function Dd({layers:i,main:e,facts:t},n,{frames:{length:s},header:r,metadata:a},o){let l=i[e].size||n,[c,h]=[r?.vertices??0,r?.faces??0],d=e>0&&!t.less?i[0].size:void 0,u=(d??0)/Math.max(l,1),{look:f,drawn:g,farthest:b,apart:p,before:m,angle:S,seconds:C,promised:E={},draco:P,notes:R=[]}=t,_=f===void 0?"":E.look?`${f.toFixed(2)} of ${E.look}`:f.toFixed(2),w=R.map(O=>["Note",O]);f!==void 0&&w.push(["Look distance",_,`${E.look?"promised; ":""}${g?`worst of ${g} frames drawn; `:""}at 1, both look the same`]),b!==void 0&&w.push([p===void 0?"Largest vertex error":"Largest surface distance",Mi(b),`of the diagonal${E.farthest?`; promised ${Mi(E.farthest)}`:""}`]),p!==void 0&&w.push(["Mean surface distance",Mi(p),"the faces differ"]),S!==void 0&&w.push(["Mean normal error",`${S.toFixed(2)}°`]),P&&w.push(["Draco at the same look",zn(P.bytes),`${P.bits} bits, ${Ld(P.bytes/l)} times as much`]),C!==void 0&&w.push(["Encoded in",ko(1e3*C)]),o!==void 0&&w.push(["Decoded in",ko(o)]),c>0&&w.push(["Mesh",`${mn(c)} vertices`,`${mn(h)} triangles`]),m&&m[1]!==h&&w.push(["Original",`${mn(m[0])} vertices`,`${mn(m[1])} triangles`]),s>1&&w.push(["Sequence",`${mn(s)} frames`,`${zn(Math.round(l/s))} a frame`]);let H=Y_(t,_,a.get("unit"));return{plain:d,size:l,claim:[H,l>0&&u>1?`${Ld(u)} times smaller`:""].filter(Boolean).join(", "),rows:w}}var zo=class{constructor(e){this.form=e;this.length=0;this.whole=!1;this.fed=0;this.stream=new Uint8Array(0);this.ended=!1;this.started=0;[this.cut,this.rate]=[e.control("cut"),e.control("rate")]}clear(){[this.stream,this.length,this.whole]=[new Uint8Array(0),0,!1],this.cut.max=this.cut.value="0"}receive(e){let t=this.length+e.length;if(t>this.stream.length){let s=new Uint8Array(Math.max(t,2*this.stream.length));s.set(this.bytes),this.stream=s}this.stream.set(e,this.length);let n=this.cut.value===this.cut.max;this.length=t,this.cut.max=String(t),n&&(this.cut.value=this.cut.max)}get bytes(){return this.stream.subarray(0,this.length)}restart(){[this.fed,this.ended,this.started]=[0,!1,performance.now()],this.first=this.complete=void 0}get isCut(){return Number(this.cut.value)<this.fed}get passed(){return performance.now()-this.started}feed(e,t){let n=Number(this.rate.value),s=Math.floor(Math.min(Number(this.cut.value),n>0?n*this.passed/.008:1/0));!t&&this.fed<s&&(e?.receiveData(this.stream.subarray(this.fed,s)),this.fed=s),!(!this.whole||this.ended||this.fed<this.length)&&(this.ended=!0,e?.receiveEof())}report(e,t){let{form:n,fed:s,length:r,first:a,complete:o}=this,l=r?Math.round(100*s/r):0;n.say("bytes",`${mn(s)} of ${mn(r)} bytes (${l} %)${this.whole?"":", more to come"}`),n.say("status",$_(e,t));let c=[["first faces",a],["complete",o]];n.say("times",c.flatMap(([h,d])=>d===void 0?[]:[`${h} after ${ko(d)}`]).join("; ")),n.root.dataset.blocks=String(e.blocks)}};function $_({header:i,blocks:e,refinedVertices:t,carried:n},s){if(!i)return"";let r=i.blocks?`${e} of ${i.blocks} blocks`:`${e} chunks of a grid`,a=i.refinement.length>0?`, ${Math.floor(100*t/i.vertices)} % refined`:"",o=s>0?`, entered at frame ${s+1}`:"",l=i.gopFrames>0?`, ${i.frames||"any number of"} frames${o}`:"",c=i.attributes>0?`, ${n.length} of ${i.attributes} attributes`:"";return`${r}${a}, ${mn(i.vertices)} vertices${l}${c}`}function Nd(i,e){i.draw();let[t,n]=[i.canvas,i.renderer.getPixelRatio()],{width:s,height:r}=t,a=Object.assign(document.createElement("canvas"),{width:s,height:r}),{color:o,borderTopColor:l}=getComputedStyle(t.parentElement),c=a.getContext("2d"),h=c.createRadialGradient(s/2,.42*r,0,s/2,.42*r,.6*Math.hypot(s,r));h.addColorStop(0,o),h.addColorStop(.85,l),c.fillStyle=h,c.fillRect(0,0,s,r),c.drawImage(t,0,0);let d=(i.mode==="one"?0:i.seam)*n;return[c.fillStyle,c.textAlign]=[getComputedStyle(t.closest(".bsm")).color,"center"],c.font=`600 ${15*n}px system-ui, sans-serif`,d>0&&c.fillRect(d-1,0,2,r),[[0,d],[d,s]].forEach(([f,g],b)=>g>f&&c.fillText(e[b],(f+g)/2,r-18*n)),a}var Lc={blocks:"Order in which blocks arrive",refined:"Vertices that refinement has moved",error:"Distance from the original"},Er=["#e9eef2","#ffe08a","#fd9a3c","#e0312d","#7a0f6b"],Ud=`linear-gradient(90deg, ${Er.join(", ")})`,Z_=Array.from({length:256},(i,e)=>{let t=e/255*(Er.length-1),n=Math.min(Math.floor(t),Er.length-2);return new Ve(Er[n]).lerp(new Ve(Er[n+1]),t-n).toArray()});function Fd(i,e){let t=Float64Array.from(i).filter(r=>r>=0).sort(),n=t[Math.floor(.995*(t.length-1))]/e||1e-9,s=10**Math.floor(Math.log10(n));return s*[1,2,5,10].find(r=>r*s>=n)}function Od(i,e,t,n=1){let{header:s,origin:r,refined:a,parted:o}=i;if(e==="plain"||e==="own"||!s)return;let l=Math.max((s.blocks||i.blocks)-1,1),c={blocks:f=>r[f]/l,refined:f=>a[f],error:f=>t[f]/n},h=i.getAttribute("position").count,d=e==="error"?t?.length??0:r.length;if(d===0||(o??{length:d}).length!==h)return;let u=new Float32Array(3*h);for(let f=0;f<h;f++)u.set(Z_[Math.round(255*Math.min(Math.max(c[e](o?o[f]:f)||0,0),1))],3*f);return u}var[Dc,Ar]=[4,2**23],K_=12,Nc=1024,J_=Float64Array.from({length:Nc},(i,e)=>[...e.toString(2)].reduce((t,n)=>8*t+Number(n),0));function Bd({frames:i,index:e,parted:t,attributes:{position:n}},s){let{positions:r,shape:a}=i[s]??{positions:n.array,shape:{index:e.array,vertices:t}},o=a.index.filter((u,f)=>[0,1,2].every(g=>r[3*a.index[f-f%3+g]]<1/0)),l=Uint32Array.from(o,u=>a.vertices?.[u]??u),c=l.reduce((u,f)=>Math.max(u,f+1),0);if(c===0)throw new Error("There are no triangles to compare.");let[h,d]=[new Float32Array(3*c),new Uint8Array(c)];return o.forEach((u,f)=>(h.set(r.subarray(3*u,3*u+3),3*l[f]),d[l[f]]=1)),{points:h,faces:l,used:Uint32Array.from(d.keys()).filter(u=>d[u])}}var Tr=class{constructor(e,t){this.points=e;this.faces=t;this.face=0;this.triangle=new Pn;this.place=new k;let n=t.length/3;if(n>Ar)throw new Error(`It has more than ${Ar} triangles; use bsm compare.`);let s=(d,u)=>(e[3*t[3*d]+u]+e[3*t[3*d+1]+u]+e[3*t[3*d+2]+u])/3,[r,a]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let d=0;d<n;d++)for(let u=0;u<3;u++)[r[u],a[u]]=[Math.min(r[u],s(d,u)),Math.max(a[u],s(d,u))];let o=(d,u)=>J_[Math.min(Nc-1,Math.floor(Nc*(s(d,u)-r[u])/(a[u]-r[u]||1)))],l=Float64Array.from({length:n},(d,u)=>(o(u,0)+2*o(u,1)+4*o(u,2))*Ar+u);this.order=l.sort().map(d=>d%Ar),this.leaves=2**Math.ceil(Math.log2(Math.max(1,n/Dc))),this.boxes=Float32Array.from({length:6*(2*this.leaves-1)},(d,u)=>u%6<3?1/0:-1/0);let{boxes:c}=this,h=(d,[u,f,g])=>{for(let b=0;b<3;b++)[c[6*d+b],c[6*d+3+b]]=[Math.min(c[6*d+b],u[f+b]),Math.max(c[6*d+3+b],u[g+b])]};for(let d=2*this.leaves-2;d>=0;d--){for(let u of this.facesOf(d))for(let f=0;f<3;f++)h(d,[e,3*t[3*u+f],3*t[3*u+f]]);if(d<this.leaves-1)for(let u of[2*d+1,2*d+2])h(d,[c,6*u,6*u+3])}}distance(e){let t=this.far(this.face,e);t>=0||(t=1/0);let n=[0];for(;n.length>0;){let s=n.pop();if(this.apart(s,e)<t){s<this.leaves-1&&n.push(...this.apart(2*s+1,e)<this.apart(2*s+2,e)?[2*s+2,2*s+1]:[2*s+1,2*s+2]);for(let r of this.facesOf(s)){let a=this.far(r,e);a<t&&([t,this.face]=[a,r])}}}return Math.sqrt(t)}facesOf(e){let t=e-this.leaves+1;return this.order.subarray(Math.max(0,Dc*t),Math.max(0,Dc*(t+1)))}far(e,t){let{a:n,b:s,c:r}=this.triangle;return[n,s,r].forEach((a,o)=>a.fromArray(this.points,3*this.faces[3*e+o])),this.triangle.closestPointToPoint(t,this.place).distanceToSquared(t)}apart(e,{x:t,y:n,z:s}){let r=(a,o)=>Math.max(this.boxes[6*e+o]-a,0,a-this.boxes[6*e+3+o]);return r(t,0)**2+r(n,1)**2+r(s,2)**2}};function*kd(i,e=t=>t){for(let t=0;t<i.length;t+=3){let[n,s,r]=[e(i[t]),e(i[t+1]),e(i[t+2])];yield(n<s&&n<r?[n,s,r]:s<r?[s,r,n]:[r,n,s]).join()}}function*j_(i,e){if(i.faces.length!==e.faces.length||i.used.length!==e.used.length)return;if(i.faces.every((o,l)=>o===e.faces[l]))return o=>o;let t=new Tr(e.points,Uint32Array.from({length:3*e.used.length},(o,l)=>e.used[Math.floor(l/3)])),[n,s,r]=[new Map,new k,new Set];for(let o of i.used)t.distance(s.fromArray(i.points,3*o)),n.set(o,e.used[t.face]),r.add(e.used[t.face]),yield;let a=new Set(kd(e.faces));if(!(r.size<i.used.length)){for(let o of kd(i.faces,l=>n.get(l)))if(!a.has(o))return;return o=>n.get(o)}}function*Q_(i,e){let[t,n]=[i,e].map(({frames:u})=>u.length);if(t!==n)throw new Error(t*n>0?`It has ${t} frames, and its original has ${n}.`:"One is a sequence, the other one is not.");let s=i.header.vertices,r=i.frames.every(({shape:u})=>u===i.frames[0].shape)&&s*t<=Ar,a=new Float32Array(r?s*Math.max(t,1):0).fill(NaN),[o,l]=[[],new k],[c,h,d]=[void 0,0,0];for(let u=0;u<Math.max(t,1);u++){let[f,g]=[Bd(i,u),Bd(e,u)];(u===0||i.frames[u].shape!==i.frames[u-1].shape||e.frames[u].shape!==e.frames[u-1].shape)&&(c=yield*j_(f,g));let b=c?void 0:new Tr(g.points,g.faces),p=0;for(let S of f.used){l.fromArray(f.points,3*S);let C=c?Math.hypot(...[0,1,2].map(E=>f.points[3*S+E]-g.points[3*c(S)+E])):b.distance(l);a[u*s+S]=C,C>p&&(p=C),b&&([h,d]=[h+C,d+1]),yield}let m=b&&new Tr(f.points,f.faces);for(let S of m?g.used:[])p=Math.max(p,m.distance(l.fromArray(g.points,3*S))),yield;o.push(p)}return{off:a,errors:o,mean:d>0?h/d:void 0}}async function zd(i,e,t){let n=Q_(i,e);for(let s=performance.now();;){let r=n.next();if(r.done)return r.value;if(!(performance.now()-s<K_)){if(await new Promise(a=>setTimeout(a)),!t())return;s=performance.now()}}}var ex=3e6,tx=4,nx=16,ix=1,Uc=class{constructor(e,t,{cell:n,origin:s}){this.entry=e;this.url=t;this.below=[];this.asked=!1;this.tried=!1;let[r,a]=[e.low,e.high].map(o=>new k(...o.map((l,c)=>l*n+s[c])));this.center=r.clone().add(a).divideScalar(2),this.radius=r.distanceTo(a)/2}off(e,t){return this.below.length===0?0:t*this.entry.error/Math.max(e.distanceTo(this.center)-this.radius,.001*this.radius)}};async function Gd(i,e,t,n){let s=await fetch(i,{headers:{Range:`bytes=${e}-${e+t-1}`}});if(s.status!==206)throw new Error(`${i}: ${s.status} ${s.statusText}`);let r=new Uint8Array(await s.arrayBuffer());if(Array.from(new Uint8Array(await crypto.subtle.digest("SHA-256",r)),o=>o.toString(16).padStart(2,"0")).join("")!==n)throw new Error(`${i}: bytes from ${e} on are not what was written`);return r}function Rr(i,e){return new Promise((t,n)=>{let s=new Xi,r=i.open({onPicture:a=>s.accept(a),onEnd:()=>t(s),onError:n},{drawing:"whole"});r.receiveData(e),r.receiveEof()})}var Go=class i{constructor(e,t,n,s){this.manifest=e;this.tops=t;this.pool=n;this.changed=s;this.problem="";this.got=0;this.there=0;this.cut=new Set;this.wanted=[];this.loading=0;this.closed=!1}static async open(e,t,n){let s=await fetch(`${e}/manifest.json`);if(!s.ok)throw new Error(`${e}: ${s.status} ${s.statusText}`);let r=await s.json();t.preload(Object.keys(r.attributes??{}).length>0?"whole":"small").catch(()=>{});let a=new Map;for(let{file:o,size:l,index:c,sha256:h}of r.shards){let d=`${e}/${o}`,u=new TextDecoder().decode(await Gd(d,l-nx-c,c,h));for(let f of JSON.parse(u))a.set(f.name,new Uc(f,d,r))}for(let[o,l]of a)a.get(o.slice(0,-1))?.below.push(l);return new i(r,[...a].flatMap(([o,l])=>a.has(o.slice(0,-1))?[]:[l]),t,n)}get extent(){let e=this.tops.reduce((t,{center:n})=>t.add(n),new k).divideScalar(this.tops.length);return{center:e.toArray(),diagonal:2*Math.max(...this.tops.map(t=>t.center.distanceTo(e)+t.radius))}}look(e,t){let n=new Set(this.tops),s=this.tops.reduce((l,{entry:c})=>l+c.faces,0),r=[...this.tops];for(;;){let l=[...n].reduce((h,d)=>d.off(e,t)>h[0]?[d.off(e,t),d]:h,[ix,void 0])[1];if(!l)break;let c=l.below.reduce((h,{entry:d})=>h+d.faces,-l.entry.faces);if(s+c>ex)break;s+=c,n.delete(l),l.below.forEach(h=>n.add(h)),r.push(...l.below)}this.cut=n,this.wanted=r;let a=new Set(r),o=l=>{!a.has(l)&&l.geometry&&([l.geometry,l.asked]=[l.geometry.dispose(),!1]),l.below.forEach(o)};this.tops.forEach(o),this.load()}get shown(){let e=t=>{let n=t.geometry&&[t.geometry];if(this.cut.has(t))return n;let s=t.below.map(e);return s.every(r=>r!==void 0)?s.flat():n};return this.tops.flatMap(t=>e(t)??[])}get complete(){return this.loading===0&&this.wanted.every(({asked:e})=>e)}close(){this.closed=!0,this.tops.forEach(function e(t){t.geometry?.dispose(),t.below.forEach(e)})}load(){for(let e of this.wanted){if(this.closed||this.loading>=(this.tops.every(({tried:t})=>t)?tx:this.tops.length))return;e.asked||(e.asked=!0,this.loading++,this.fetched(e).finally(()=>{this.loading--,e.tried=!0,this.load(),this.closed||this.changed()}))}}async fetched(e){let{offset:t,size:n,sha256:s,name:r}=e.entry;try{let a=await Gd(e.url,t,n,s),o=await Rr(this.pool,a);if(this.got+=a.length,this.there++,this.closed||!this.wanted.includes(e)){o.dispose(),e.asked=!1;return}e.geometry=o}catch(a){this.problem=`Tile ${r} cannot be shown; showing a coarser tile: ${a instanceof Error?a.message:a}`}}};var sx=4,Vo=class{constructor(e,t){this.form=e;this.stage=t;this.stale=!1;this.shown=!0;this.accompanied=!1;this.content={name:"",main:0,layers:[],facts:{}};this.geometries=[];this.offs=[];this.dressed=new Set;this.scheme=e.control("color"),e.part("scale").querySelector("div").style.background=Ud,e.on("mode","change",()=>this.compare()),e.on("wipe","input",()=>this.compare()),e.on("shading","change",({value:n})=>t.shade(n)),e.on("color","change",()=>this.stale=!0)}open(e){let{form:t}=this,{layers:n,main:s}=this.content=e;[this.geometries,this.offs,this.accompanied,this.top]=[[],[],!1,void 0],this.dressed.clear(),delete t.root.dataset.layers,this.stage.clear();let r=t.part("layers");r.hidden=t.part("modes").hidden=n.length<2,r.replaceChildren(r.querySelector("legend")),n.forEach(({title:a,detail:o,size:l},c)=>{let h={type:"radio",name:"layer",value:String(c),disabled:c!==s,checked:c===s},d=Object.assign(document.createElement("input"),h);d.addEventListener("change",()=>this.compare());let u=An("small",`${zn(l)}${o?`, ${o}`:""}`);r.append(An("label","",d,new Text(a),u))}),t.root.querySelector("[name=mode][value=one]").checked=!0,this.allow("error",!1),this.compare()}begin(e){let{main:t}=this.content;this.geometries[t]=e,this.dressed.delete(t),this.dressed.size===0&&this.allow("own",!1),this.shown=!1}show(e,t,n){this.shown||(this.shown=this.stale=!0,this.stage.show(this.content.main,e),this.stage.place(t,n,Bo(e.metadata)))}async accompany(e,t){let{layers:n,main:s}=this.content,{form:r,geometries:a,offs:o,stage:l}=this;await this.dress(s);for(let[c,h]of n.entries()){let d=h.off&&new Float32Array((await Xn(h.off)).buffer),u=c===s?void 0:await Rr(e,await Xn(h));if(!t())return;if(o[c]=d,this.top=void 0,d&&this.allow("error",!0),this.stale=!0,!u||(a[c]=u,l.show(c,u),await this.dress(c),this.recolor(),r.root.querySelector(`[name=layer][value="${c}"]`).disabled=!1,c>0))continue;let f=r.control("wipe");l.halve(),f.value=String(Math.round(l.wipe*Number(f.max))),r.pick("mode","wipe")}await this.measure(t),t()&&(r.root.dataset.layers=String(n.length))}seek(e){for(let t of this.geometries)t?.frames.length&&t.showFrame(Math.min(e,t.frames.length-1))}async measure(e){let{content:{facts:t,main:n},geometries:{0:s,[n]:r},offs:a}=this;if(n===0||t.diagonal!==void 0||!s||!r)return;let o=await zd(r,s,e);if(!o)return;let{off:l,errors:c,mean:h}=o;t.diagonal=s.boundingBox.getSize(new k).length()||1;let[d,...u]=[Math.max(...c),...c].map(f=>f/t.diagonal);Object.assign(t,{farthest:d,errors:r.frames.length>0?u:[],apart:h&&h/t.diagonal,before:[s.header.vertices,s.header.faces]}),a[n]=l.length>0?l:void 0,this.top=void 0,this.allow("error",l.length>0),this.stale=!0}async dress(e=this.content.main){let{geometries:t,scheme:n}=this,{metadata:s,color:r,pieces:a}=t[e],o=[...s.keys()].some(l=>l.startsWith("material."));if(o){let l=await Pd(s);if(s!==this.geometries[e]?.metadata)return;let c=Id(s,l,1+Math.max(0,...a.map(({material:h})=>h)));for(let h of c)h.vertexColors=r!==void 0;this.stage.dress(e,c),this.dressed.add(e)}!o&&!r||(this.allow("own",!0),n.value==="plain"&&(n.value="own"),this.stale=!0)}toggleErrors(){let e=this.dressed.size>0||this.geometries[this.content.main]?.color,t=this.scheme.value!=="error"?"error":e?"own":"plain";this.option(t).disabled||(this.scheme.value=t),this.stale=!0}place(){let{stage:e,form:t}=this,n=t.root.querySelector(".bsm-dock");t.root.style.setProperty("--dock",`${t.root.clientHeight-n.offsetTop}px`),["left","right"].forEach((h,d)=>t.say(h,e.mode==="one"?"":this.captions[d])),e.fit();let[s,r,{clientWidth:a}]=[e.mode==="split",e.seam,t.root],[o,l]=["left","right"].map(h=>t.part(h).offsetWidth+sx),c=s?[r/2,(r+a)/2]:[Math.max(r-14,o),Math.min(r+14,a-l)];["left","right"].forEach((h,d)=>{t.part(h).style.left=`${c[d]}px`,t.part(h).style.setProperty("--shift",s?"-50%":d===0?"-100%":"0%")})}get captions(){let{layers:e}=this.content;return this.stage.sides.map(t=>e[t]?`${e[t].title}, ${zn(e[t].size)}`:"")}recolor(){let{content:e,form:t,geometries:n,offs:s,stage:r}=this,a=e.tiles===void 0?this.scheme.value:"plain",o=a==="own",{diagonal:l=1}=e.facts,c=this.top??=l*Fd(s[e.main]??[0],l);this.stale=!1,n.forEach((g,b)=>{if(!g||b===e.main&&!this.shown)return;let p=g.header?.vertices??0,m=s[b]?.subarray(...g.frames.length>1?[g.shown*p,(g.shown+1)*p]:[]),S=Od(g,a,m,c);r.color(b,o?g.color:S&&new vt(S,3),o&&this.dressed.has(b))}),t.part("scale").hidden=!Lc[a],t.say("legend",`${Lc[a]??""}${a==="error"&&e.facts.apart!==void 0?"'s surface":""}`);let h=n[e.main]?.metadata.get("unit"),d=g=>{let b=`${Number((g*c).toPrecision(2))} ${typeof h=="string"?h:""}`;return An("li",Mi(g*c/l),An("small",b))},f=a==="error"?[0,.5,1].map(d):(a==="blocks"?["first","last"]:["not","refined"]).map(g=>An("li",g));t.part("scale").querySelector("ol").replaceChildren(...f)}compare(){let{content:e,form:t,stage:n}=this,s=t.control("wipe"),r=Number(t.picked("layer")||e.main);t.part("modes").toggleAttribute("disabled",r===0&&e.main>0),n.mode=r===0?"one":t.picked("mode")||"one",n.sides=[0,r],n.wipe=Number(s.value)/Number(s.max),s.hidden=n.mode!=="wipe",n.mode==="split"&&t.part("more").removeAttribute("open"),this.place(),this.stale=!0}option(e){return this.scheme.querySelector(`[value=${e}]`)}allow(e,t){let n=this.option(e);n.hidden=n.disabled=!t,n.selected&&!t&&(this.scheme.value="plain")}};var Ho=class{constructor(e){this.root=e}control(e){return this.root.querySelector(`[name=${e}]`)}part(e){return this.root.querySelector(`[data-part=${e}]`)}on(e,t,n){for(let s of this.root.querySelectorAll(`[name=${e}]`))s.addEventListener(t,()=>n(s))}say(e,t){let n=this.part(e);n.textContent!==t&&(n.textContent=t)}picked(e){return this.root.querySelector(`[name=${e}]:checked`)?.value??""}pick(e,t){this.root.querySelector(`[name=${e}][value="${t}"]:not(:disabled)`)?.click()}unfold(e){for(let t of["panel","keys"]){let n=t!==e||!this.part(t).hidden;this.part(t).hidden=n,this.control(t).setAttribute("aria-expanded",String(!n))}}};var rx=["1","2","3"],Fc=["smooth","flat","wire"];function Vd(i,e,t){let n=r=>i.pick("mode",e.mode===r?"one":r),s={w:()=>n("wipe"),s:()=>n("split"),f:()=>e.home(),m:()=>i.control("full").click(),d:()=>i.pick("shading",Fc[(Fc.indexOf(i.picked("shading"))+1)%Fc.length]),e:()=>t.toggleErrors(),t:()=>i.control("spin").click(),l:()=>{let r=i.control("light");r.value=String((Number(r.value)+210)%360-180),e.light=Number(r.value)},h:()=>i.root.toggleAttribute("data-bare"),",":()=>i.control("earlier").click(),".":()=>i.control("later").click()," ":()=>i.control("play").click(),"?":()=>i.unfold("keys"),escape:()=>i.unfold("")};rx.forEach((r,a)=>s[r]=()=>i.pick("layer",String(a))),i.root.addEventListener("keydown",({key:r,target:a,ctrlKey:o,metaKey:l,altKey:c})=>{o||l||c||a.matches("select, [type=number]")||r===" "&&!a.matches("canvas, body")||s[r.toLowerCase()]?.()})}var Wo=class{constructor(e,t){this.given=e;this.loop=!0;this.at=.1;this.before=0;this.waiting=!0;this.playing=t}get rate(){return this.given>0?this.given:24}get frame(){return Math.floor(this.at)}seek(e){this.at=e+.1}step(e,t,n){let s=Math.max(0,e-this.before)/1e3*this.rate;this.before=e,t!==0&&(this.waiting?this.waiting=!n&&t-this.at<.5*this.rate:this.playing&&(this.at+=s),!(this.at<t)&&(n&&this.playing&&this.loop?this.at=.1:(this.at=t-1,this.playing&&=!n,this.waiting=!n)))}};var ax=1e3,Xo=class extends rn{constructor(t,n=!0){super();this.geometry=t;this.complete=!1;this.speed=1;this.now=0;this.wasWaiting=!1;this.playback=new Wo(t.frameRate,n)}get rate(){return this.playback.rate}get length(){return this.complete?this.geometry.frames.length:Math.max(this.geometry.header?.frames??0,this.geometry.frames.length)}get duration(){return this.length/this.rate}get frame(){return Math.max(0,this.geometry.shown)}get playing(){return this.playback.playing}get loop(){return this.playback.loop}set loop(t){this.playback.loop=t}play(){return this.complete&&!this.loop&&this.frame>=this.length-1&&this.playback.seek(0),this.playback.playing=!0,this.dispatchEvent({type:"play"}),this}pause(){return this.playback.playing=!1,this.dispatchEvent({type:"pause"}),this}seek(t){return this.playback.seek(Math.min(Math.max(0,Math.floor(t)),this.geometry.frames.length-1)),this.show(this.playback.frame),this}update(t){let{playback:n,geometry:s}=this,[r,a]=[n.frame,n.playing];this.now+=t*this.speed*ax||0,n.step(this.now,s.frames.length,this.complete),n.waiting&&!this.wasWaiting&&this.dispatchEvent({type:"waiting"}),this.wasWaiting=n.waiting,n.frame<r&&n.playing&&this.dispatchEvent({type:"loop"}),this.show(n.frame),a&&!n.playing&&this.dispatchEvent({type:"ended"})}mesh(t){let n=new Gt(this.geometry,t);return n.frustumCulled=!1,n}fail(t){this.complete||(this.complete=!0,this.dispatchEvent({type:"error",error:t}))}dispose(){this.playback.playing=!1,this.complete=!0,this.dispatchEvent({type:"dispose"}),this.geometry.frames.length=0,this.geometry.dispose()}show(t){t===this.geometry.shown||t>=this.geometry.frames.length||(this.geometry.showFrame(t),this.dispatchEvent({type:"frame",index:t}))}};var qo=class{constructor(e){this.form=e;this.before=0;this.shown=-1;this.errors=[];this.frame=e.control("frame"),e.on("play","click",()=>this.sequence&&(this.sequence.playing?this.sequence.pause():this.sequence.play())),e.on("frame","input",({value:t})=>this.sequence?.seek(Number(t)));for(let[t,n]of[["earlier",-1],["later",1]])e.on(t,"click",()=>this.go(n));e.on("loop","change",({checked:t})=>this.sequence&&(this.sequence.loop=t))}open(e){[this.sequence,this.shown]=[void 0,-1],this.plot(e)}plot({errors:e=[],farthest:t}){this.errors=e;let n=e.map((s,r)=>`L${r/(e.length-1)},${1-s/(t||1)}`);this.form.part("errors").toggleAttribute("hidden",n.length<2),this.form.part("errors").querySelector("path").setAttribute("d",`M0,1${n.join("")}L1,1z`)}begin(e){this.sequence??=new Xo(e,!matchMedia("(prefers-reduced-motion: reduce)").matches),this.sequence.loop=this.form.control("loop").checked}step(e,t,n){let{sequence:s,form:r}=this;if(r.part("sequence").hidden=!s,!s)return!1;s.complete=t,s.speed=Number(r.control("speed").value),s.update((e-this.before)/1e3),this.before=e,this.report(s,n);let a=s.frame!==this.shown;return this.shown=s.frame,a}go(e){let{sequence:t}=this;if(!t)return;let n=t.geometry.frames.length;t.pause(),t.seek((t.frame+e+n)%n)}report({frame:e,geometry:t,playing:n,rate:s},r){let{form:a,frame:o}=this,l=t.frames.length,c=Math.max(t.header.frames-r,l);a.root.dataset.frame=String(e),a.root.dataset.there=String(l),o.max=String(c-1),o.value=String(e),a.control("play").textContent=n?"Pause":"Play";let h=l<c?`, ${l} are there`:"",d=`${r+e+1} of ${r+c}`,u=this.errors[e],f=u===void 0?"":`; error ${Mi(u)}`;a.say("time",`${d}${h}; ${((r+e)/s).toFixed(2)} s${f}`),o.setAttribute("aria-valuetext",`frame ${d}`)}};var Hd={type:"change"},Bc={type:"start"},Xd={type:"end"},Yo=new xs,Wd=new sn,ox=Math.cos(70*En.DEG2RAD),Ct=new k,Qt=2*Math.PI,nt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Oc=1e-6,$o=class extends ur{constructor(e,t=null){super(e,t),this.state=nt.NONE,this.target=new k,this.cursor=new k,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:xi.ROTATE,MIDDLE:xi.DOLLY,RIGHT:xi.PAN},this.touches={ONE:vi.ROTATE,TWO:vi.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new k,this._lastQuaternion=new an,this._lastTargetPosition=new k,this._quat=new an().setFromUnitVectors(e.up,new k(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Un,this._sphericalDelta=new Un,this._scale=1,this._panOffset=new k,this._rotateStart=new Oe,this._rotateEnd=new Oe,this._rotateDelta=new Oe,this._panStart=new Oe,this._panEnd=new Oe,this._panDelta=new Oe,this._dollyStart=new Oe,this._dollyEnd=new Oe,this._dollyDelta=new Oe,this._dollyDirection=new k,this._mouse=new Oe,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=cx.bind(this),this._onPointerDown=lx.bind(this),this._onPointerUp=hx.bind(this),this._onContextMenu=yx.bind(this),this._onMouseWheel=fx.bind(this),this._onKeyDown=px.bind(this),this._onTouchStart=mx.bind(this),this._onTouchMove=gx.bind(this),this._onMouseDown=ux.bind(this),this._onMouseMove=dx.bind(this),this._interceptControlDown=_x.bind(this),this._interceptControlUp=xx.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=nt.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Hd),this.update(),this.state=nt.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;Ct.copy(t).sub(this.target),Ct.applyQuaternion(this._quat),this._spherical.setFromVector3(Ct),this.autoRotate&&this.state===nt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=Qt:n>Math.PI&&(n-=Qt),s<-Math.PI?s+=Qt:s>Math.PI&&(s-=Qt),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let a=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=a!=this._spherical.radius}if(Ct.setFromSpherical(this._spherical),Ct.applyQuaternion(this._quatInverse),t.copy(this.target).add(Ct),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let a=null;if(this.object.isPerspectiveCamera){let o=Ct.length();a=this._clampDistance(o*this._scale);let l=o-a;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let o=new k(this._mouse.x,this._mouse.y,0);o.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new k(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(o),this.object.updateMatrixWorld(),a=Ct.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;a!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(a).add(this.object.position):(Yo.origin.copy(this.object.position),Yo.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(Yo.direction))<ox?this.object.lookAt(this.target):(Wd.setFromNormalAndCoplanarPoint(this.object.up,this.target),Yo.intersectPlane(Wd,this.target))))}else if(this.object.isOrthographicCamera){let a=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),a!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>Oc||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Oc||this._lastTargetPosition.distanceToSquared(this.target)>Oc?(this.dispatchEvent(Hd),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?Qt/60*this.autoRotateSpeed*e:Qt/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Ct.setFromMatrixColumn(t,0),Ct.multiplyScalar(-e),this._panOffset.add(Ct)}_panUp(e,t){this.screenSpacePanning===!0?Ct.setFromMatrixColumn(t,1):(Ct.setFromMatrixColumn(t,0),Ct.crossVectors(this.object.up,Ct)),Ct.multiplyScalar(e),this._panOffset.add(Ct)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Ct.copy(s).sub(this.target);let r=Ct.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/n.clientHeight,this.object.matrix),this._panUp(2*t*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),s=e-n.left,r=t-n.top,a=n.width,o=n.height;this._mouse.x=s/a*2-1,this._mouse.y=-(r/o)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(Qt*this._rotateDelta.x/t.clientHeight),this._rotateUp(Qt*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(Qt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-Qt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(Qt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-Qt*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(n,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let n=this._getSecondPointerPosition(e),s=.5*(e.pageX+n.x),r=.5*(e.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(Qt*this._rotateDelta.x/t.clientHeight),this._rotateUp(Qt*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let a=(e.pageX+t.x)*.5,o=(e.pageY+t.y)*.5;this._updateZoomParameters(a,o)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new Oe,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function lx(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function cx(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function hx(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(Xd),this.state=nt.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function ux(i){let e;switch(i.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case xi.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=nt.DOLLY;break;case xi.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=nt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=nt.ROTATE}break;case xi.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=nt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=nt.PAN}break;default:this.state=nt.NONE}this.state!==nt.NONE&&this.dispatchEvent(Bc)}function dx(i){switch(this.state){case nt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case nt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case nt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function fx(i){this.enabled===!1||this.enableZoom===!1||this.state!==nt.NONE||(i.preventDefault(),this.dispatchEvent(Bc),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(Xd))}function px(i){this.enabled!==!1&&this._handleKeyDown(i)}function mx(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case vi.ROTATE:if(this.enableRotate===!1){this.state=nt.NONE;break}this._handleTouchStartRotate(i),this.state=nt.TOUCH_ROTATE;break;case vi.PAN:if(this.enablePan===!1){this.state=nt.NONE;break}this._handleTouchStartPan(i),this.state=nt.TOUCH_PAN;break;default:this.state=nt.NONE}break;case 2:switch(this.touches.TWO){case vi.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=nt.TOUCH_DOLLY_PAN;break;case vi.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=nt.TOUCH_DOLLY_ROTATE;break;default:this.state=nt.NONE}break;default:this.state=nt.NONE}this.state!==nt.NONE&&this.dispatchEvent(Bc)}function gx(i){switch(this._trackPointer(i),this.state){case nt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case nt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case nt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case nt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=nt.NONE}}function yx(i){this.enabled!==!1&&i.preventDefault()}function _x(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function xx(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var Zo=Math.PI/24,qd=1.1,vx={ArrowLeft:[-Zo,0,1],ArrowRight:[Zo,0,1],ArrowUp:[0,-Zo,1],ArrowDown:[0,Zo,1],"+":[0,0,1/qd],"-":[0,0,qd]};function Yd(i,e,t){let n=vx[i];if(!n)return!1;let s=new Un().setFromVector3(e.position.sub(t));return s.theta+=n[0],s.phi+=n[1],s.radius*=n[2],e.position.setFromSpherical(s.makeSafe()).add(t),!0}var Zd=30/180*Math.PI,bx=1.06/Math.sin(Zd/2),Mx=.94,$d=new Un(1,72*En.DEG2RAD,35*En.DEG2RAD),Sx=.15;function Kd(i){let[e,t]=[new k,new k];for(let n=0;n<(i?.count??0);n++)e.add(t.fromBufferAttribute(i,n));return e.divideScalar(i?.count||1)}var Ko=class extends Wt{constructor(t,n){super(30,1,.01,100);this.redraw=n;this.touched=!1;this.size=[1,1];this.middle=.5;this.part=[1,1];this.controls=new $o(this,t),this.controls.enableDamping=!0,this.controls.autoRotateSpeed=4,this.controls.addEventListener("change",n),this.controls.addEventListener("start",()=>this.touched=!0),t.addEventListener("keydown",s=>this.turn(s)),this.reset()}reset(){this.touched=!1,this.position.setFromSpherical($d).setLength(bx/2),this.controls.target.set(0,0,0)}fit(t,n,s){this.size=[t,n],this.part=[t/s,Math.max(n,1)],this.view||(this.middle=this.part[0]/2),this.aspect=this.part[0]/this.part[1],this.fov=2*En.RAD2DEG*Math.atan(Math.tan(Zd/2)/Math.min(this.aspect,1)),this.updateProjectionMatrix()}get pixels(){return this.size[1]*devicePixelRatio/(2*Math.tan(this.fov/2/En.RAD2DEG))}aim(t,n,s,r){let a=$d.clone();Math.hypot(s.x,s.z)>Sx&&(a.theta+=Math.atan2(s.x,s.z)),this.controls.target.set(0,0,0),this.position.setFromSpherical(a),this.controls.update();let[o,l]=this.part,c=n.clone().premultiply(new ht().makeRotationFromQuaternion(this.quaternion.clone().invert())),h=Mx*Math.tan(this.fov/2/En.RAD2DEG)/l,d=r.map(()=>.1);t(m=>{let{x:S,y:C,z:E}=m.applyMatrix4(c);r.forEach(({left:P,right:R,top:_,bottom:w},H)=>{let O=E+Math.max(Math.abs(S)/(R-P),Math.abs(C)/(w-_))/h;O>d[H]&&(d[H]=O)})});let u=d.indexOf(Math.min(...d)),{left:f,right:g,top:b,bottom:p}=r[u];this.middle=(f+g)/2,this.setViewOffset(o,l,(o-f-g)/2,(l-b-p)/2,o,l),this.position.setLength(d[u]),this.redraw()}turn(t){Yd(t.key,this,this.controls.target)&&(t.preventDefault(),this.touched=!0,this.controls.update(),this.redraw())}};var wx=[[-.6,.65,.5,3.5,14],[.9,.25,.35,.6,5],[.35,.5,-.8,2.5,10]],[Ex,kc,Ax]=[.62,.42,.2],[qi,Cr]=[128,64];function Jd(){let i=new Uint16Array(4*qi*Cr),[e,t,n]=[new k,new hr,new Array(9)];for(let r=0;r<qi*Cr;r++){e.setFromSphericalCoords(1,Math.PI*(1-(Math.floor(r/qi)+.5)/Cr),2*Math.PI*(r%qi+.5)/qi);let a=kc+(e.y>0?Ex-kc:kc-Ax)*e.y,o=wx.reduce((c,[h,d,u,f,g])=>c+f*Math.exp(g*(e.dot(new k(h,d,u).normalize())-1)),a);[1.02,1,.97,1].forEach((c,h)=>i[4*r+h]=Qs.toHalfFloat(h<3?c*o:1)),bs.getBasisAt(e,n);let l=2*Math.PI*Math.PI/qi/Cr*Math.sqrt(1-e.y*e.y);t.sh.coefficients.forEach((c,h)=>c.addScalar(n[h]*o*l))}let s=new Oi(i,qi,Cr);return Object.assign(s,{type:hn,mapping:As,magFilter:Et,minFilter:Et,needsUpdate:!0}),{texture:s,probe:t}}var en=96,Tx=.5,Rx=7,Cx=1e5,Ls=2;function jd(i,e,t,n=new Oi(new Uint8Array(4*en*en),en,en)){let s=new Float32Array(en*en),[r,a,o]=[new k,new k,new k],l=3*Math.ceil(i.reduce((h,{drawRange:d})=>h+d.count,0)/3/Cx);for(let h of i){let[d,u]=[h.getAttribute("position"),h.getIndex()];for(let f=0;f+2<Math.min(h.drawRange.count,u.count);f+=l){[r,a,o].forEach((b,p)=>b.fromBufferAttribute(d,u.getX(f+p)).applyMatrix4(e));let g=Math.min(Math.ceil(Math.max(r.distanceTo(a),a.distanceTo(o),o.distanceTo(r))/Ls*en),en)||1;for(let b=0;b<=g;b++)for(let p=0;b+p<=g;p++){let[m,S]=[b/g,p/g],[C,E,P]=[r.x+m*(a.x-r.x)+S*(o.x-r.x),r.y+m*(a.y-r.y)+S*(o.y-r.y),r.z+m*(a.z-r.z)+S*(o.z-r.z)],R=en*Math.floor((.5-P/Ls)*en)+Math.floor((.5+C/Ls)*en),_=Tx*Math.exp(Rx*(t-E));s[R]<_&&(s[R]=_)}}}for(let h of[1,en,1,en,1,en])s=s.map((d,u)=>(s[u-2*h]+s[u-h]+s[u]+s[u+h]+s[u+2*h])/5||0);let c=n.image.data;return s.forEach((h,d)=>c[4*d+1]=255*h),Object.assign(n,{magFilter:Et,minFilter:Et,needsUpdate:!0}),n}function zc(i,e){let{left:t,top:n}=i.getBoundingClientRect(),s=[...i.querySelectorAll(e)].map(o=>o.getBoundingClientRect()).filter(({width:o,height:l})=>o*l>0);if(s.length===0||i.hasAttribute("data-bare"))return;let[r,a]=[s.flatMap(o=>[o.left-t,o.right-t]),s.flatMap(o=>[o.top-n,o.bottom-n])];return{left:Math.min(...r),top:Math.min(...a),right:Math.max(...r),bottom:Math.max(...a)}}function Qd(i,e){let[t,n]=[i.clientWidth/e,i.clientHeight],s=zc(i,".bsm-card, .bsm-scale")??{left:0,top:0,right:0,bottom:0},r=zc(i,".bsm-tools > *")??{left:t,top:0,right:t,bottom:0},a=Math.min(n,...[".bsm-dock > *",".bsm-tag",".bsm-ruler"].map(h=>zc(i,h)?.top??n)),o={left:0,top:Math.max(s.bottom,r.bottom),right:t,bottom:a},c=(e>1?[o]:[o,{left:0,top:s.bottom,right:r.left,bottom:a},{left:s.right,top:0,right:r.left,bottom:a},{left:s.right,top:r.bottom,right:t,bottom:a}]).filter(({left:h,top:d,right:u,bottom:f})=>u-h>90&&f-d>90);return c.length>0?c:[{left:0,top:0,right:t,bottom:n}]}var tf=13485754,ef=16777215,Jo=44,[Px,Ix]=[400,2],Lx=5e4,Pr=class{constructor(){this.holder=new Ln;this.clay=new ki({color:tf,roughness:.6,side:Jt});this.clothes=[]}put(e){let t=new Set(e);for(let n of[...this.meshes])t.delete(n.geometry)||(this.holder.remove(n),n.geometry.dispose());for(let n of t){let s=new Gt(n,this.clay);s.frustumCulled=e.length>1,this.holder.add(s)}for(let n of this.clothes)n.dispose();this.clothes=[]}get meshes(){return this.holder.children}get materials(){return[this.clay,...this.clothes]}};function Dx(){let i=document.createElement("canvas").getContext("webgl2",{failIfMajorPerformanceCaveat:!0}),e=i?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL??i?.RENDERER,t=e?String(i.getParameter(e)):"software";return i?.getExtension("WEBGL_lose_context")?.loseContext(),!/software|swiftshader|llvmpipe|basic render/i.test(t)}var jo=class{constructor(e){this.canvas=e;this.mode="one";this.sides=[0,0];this.wipe=.5;this.scene=new js;this.fast=Dx();this.key=new cr(ef,1.5);this.ground=new Gt(new Bi(Ls,Ls),new Fi({color:0,transparent:!0,depthWrite:!1,toneMapped:!1}));this.wires=new Fi({wireframe:!0,color:1053720,transparent:!0,opacity:.35});this.turned=new Ln;this.drawn=[new Pr,new Pr,new Pr];this.middle=new k;this.depth=1/0;this.aim=()=>{};this.shading="smooth";this.stale=!0;this.moved=0;this.renderer=new Uo({canvas:e,antialias:this.fast,alpha:!0}),this.renderer.setPixelRatio(devicePixelRatio),this.renderer.autoClear=!1,this.renderer.toneMapping=fr,this.camera=new Ko(e,()=>this.redraw());let{texture:t,probe:n}=Jd(),s=()=>{this.scene.environment=new Ps(this.renderer).fromEquirectangular(t).texture};this.fast?s():this.scene.add(n),e.addEventListener("webglcontextrestored",()=>{this.fast&&s(),this.redraw()}),e.addEventListener("dblclick",()=>this.home()),this.light=0,this.ground.rotation.x=-Math.PI/2,this.ground.visible=!1,this.scene.add(this.key,this.ground,this.turned),this.turned.add(...this.drawn.map(({holder:r})=>r))}show(e,...t){let n=this.drawn[e];n.put(t),this.whiten(n.clay,t.some(s=>s.hasAttribute("color"))),this.shade(this.shading)}place(e,t,n=[0,0,0]){let{turned:s}=this;s.rotation.set(...n),s.scale.setScalar(1/t),this.middle.fromArray(e),this.follow(this.middle)}follow(e){let{ground:t,turned:n}=this;n.position.copy(e).negate().multiplyScalar(n.scale.x).applyEuler(n.rotation),n.updateWorldMatrix(!0,!1);let s=this.middle.clone().sub(e).multiplyScalar(n.scale.x).applyEuler(n.rotation);t.position.y=this.depth+s.y,this.redraw()}fill(e,t,n,s=[]){let{camera:r,turned:a}=this,[o,l,c]=[1/0,-1/0,0].map(m=>new k(m,m,m)),[h,d]=[s[0]??new k,e.reduce((m,{length:S})=>m+S/3,0)],u=(m,S=3)=>{e.forEach((C,E)=>{for(let P=0;P<C.length;P+=S)C[P]===C[P]&&m(s[E]?c.fromArray(C,P).sub(s[E]).add(h):c.fromArray(C,P))})};if(u(()=>(o.min(c),l.max(c))),!(o.x<=l.x))return;r.touched||this.place(o.clone().add(l).divideScalar(2).toArray(),o.distanceTo(l)||1,t);let f=1/0;u(()=>f=Math.min(f,c.applyMatrix4(a.matrixWorld).y)),[this.depth,this.ground.position.y]=[f,f];let g=m=>u(m,3*Math.ceil(d/Lx)),[b,p]=[a.matrixWorld.clone(),Kd(n).applyEuler(a.rotation)];this.aim=()=>r.aim(g,b,p,Qd(this.canvas.closest(".bsm"),this.mode==="split"?2:1)),r.touched||this.aim()}home(){this.camera.touched=!1,this.aim()}shadow(...e){let{ground:t,turned:n}=this;this.depth!==1/0&&(t.material.alphaMap=jd(e,n.matrixWorld,t.position.y,t.material.alphaMap??void 0),t.material.needsUpdate||=!t.visible,t.visible=!0,this.redraw())}clear(){for(let e of this.drawn)e.put([]);this.ground.visible=!1,this.depth=1/0,this.aim=()=>{},this.camera.reset(),this.redraw()}get eye(){return this.turned.updateWorldMatrix(!0,!1),this.turned.worldToLocal(this.camera.position.clone())}get pixel(){let{camera:e,turned:t}=this;return e.position.distanceTo(e.controls.target)*devicePixelRatio/e.pixels/t.scale.x}dress(e,t){this.drawn[e].clothes=t,this.shade(this.shading)}shade(e){this.shading=e;for(let t of this.drawn){for(let n of t.materials)n.flatShading=e!=="smooth",n.polygonOffset=e==="wire",n.polygonOffsetFactor=n.polygonOffsetUnits=1,n.needsUpdate=!0;t.meshes.forEach(n=>this.edge(n))}this.redraw()}color(e,t,n=!1){let{meshes:s,clay:r,clothes:a}=this.drawn[e];for(let o of s)o.material=n&&a.length>0?a.length>1?a:a[0]:r,t&&o.geometry.setAttribute("color",t);this.whiten(r,t!==void 0),this.redraw()}set light(e){let t=e*En.DEG2RAD;this.scene.environmentRotation.y=t,this.key.position.set(-1.2,1.9,1.5).applyAxisAngle(this.scene.up,t),this.redraw()}halve(){this.wipe=Math.min(1,Math.max(0,(this.camera.middle-Jo/2)/(this.camera.size[0]-Jo)))}get seam(){return this.mode==="split"?this.camera.size[0]/2:Jo/2+this.wipe*(this.camera.size[0]-Jo)}redraw(){this.stale=!0}step(){this.camera.controls.update();let e=performance.now();this.stale?this.renew(1,e):!this.fast&&e-this.moved>Px&&this.renderer.getPixelRatio()===devicePixelRatio&&this.renew(Ix,this.moved)}dispose(){this.camera.controls.dispose(),this.clear(),this.renderer.dispose(),this.renderer.forceContextLoss()}renew(e,t){this.moved=t;let n=e*devicePixelRatio;this.renderer.getPixelRatio()!==n&&this.renderer.setPixelRatio(n),this.draw()}draw(){this.stale=!1;let[e,t]=this.camera.size,{renderer:n,sides:s}=this;if(n.setScissorTest(!1),n.setViewport(0,0,e,t),n.clear(),this.mode==="one")return this.render(s[1]);let{seam:r}=this;n.setScissorTest(!0);for(let[a,o,l]of[[0,0,r],[1,r,e]])n.setScissor(o,0,l-o,t),this.mode==="split"&&n.setViewport(o,0,l-o,t),this.render(s[a])}render(e){this.drawn.forEach((t,n)=>t.holder.visible=n===e),this.renderer.render(this.scene,this.camera)}edge(e){if(e.clear(),this.shading!=="wire")return;let t=new Gt(e.geometry,this.wires);t.frustumCulled=e.frustumCulled,e.add(t)}whiten(e,t){e.vertexColors!==t&&(e.vertexColors=t,e.color.set(t?ef:tf),e.needsUpdate=!0)}fit(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement,{camera:n,renderer:s}=this;(e!==n.size[0]||t!==n.size[1])&&s.setSize(e,t,!1),n.fit(e,t,this.mode==="split"?2:1),n.touched||this.aim(),this.draw()}};var Nx=.4,Ux=.5,Fx=2e3,Qo=class{constructor(e,t){this.middles=[];let n=e.map(Ox),r=n.reduce((h,d)=>h.union(d),new ln).getCenter(new k),a=n.map(h=>h.getSize(new k).length()).sort((h,d)=>h-d),o=n.map(h=>h.getCenter(new k));if(Math.max(0,...o.map(h=>h.distanceTo(r)))<=Nx*(a[a.length>>1]??1)){this.middles=o.map(()=>r);return}let c=Math.max(1,Math.round(Ux*t));this.middles=o.map((h,d)=>{let u=o.slice(Math.max(0,d-c),d+c+1);return u.reduce((f,g)=>f.add(g),new k).divideScalar(u.length)})}at(e){return this.middles[Math.min(e,this.middles.length-1)]??new k}};function Ox(i){let[e,t]=[new ln,new k],n=3*Math.ceil(i.length/3/Fx);for(let s=0;s+2<i.length;s+=n)i[s]===i[s]&&e.expandByPoint(t.fromArray(i,s));return e}var nf=`<style>
.bsm { --ink: light-dark(#16181d, #f2f3f5); --soft: light-dark(#5b6270, #a5adba); --face: light-dark(#ffffffd9, #1b1e25d9); --line: light-dark(#0f172a1f, #ffffff24); --hot: light-dark(#0b63ce, #7db7ff); --on-hot: light-dark(#fff, #0d1117); --good: light-dark(#0a7d4f, #5ee0a4); --near: light-dark(#fdfdfe, #363b46); --far: light-dark(#d9dee6, #14161b);
  position: relative; height: 100%; overflow: hidden; container-type: size; color-scheme: light dark; color: var(--ink); font: 14px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; font-variant-numeric: tabular-nums; -webkit-text-size-adjust: 100%; }
.bsm[data-theme=light] { color-scheme: light; } .bsm[data-theme=dark] { color-scheme: dark; }
.bsm[data-back=white] { --near: #fff; --far: #fff; } .bsm[data-back=gray] { --near: #8b9099; --far: #8b9099; } .bsm[data-back=black] { --near: #000; --far: #000; }
.bsm *, .bsm ::before { box-sizing: border-box; }
.bsm [hidden] { display: none !important; }
.bsm :focus-visible { outline: 2px solid var(--hot); outline-offset: 2px; }
.bsm-stage { position: absolute; inset: 0; color: var(--near); border: 0 solid var(--far); background: radial-gradient(circle at 50% 42%, var(--near), var(--far) 85%); }
.bsm canvas { width: 100%; height: 100%; display: block; touch-action: none; outline-offset: -3px; cursor: grab; }
.bsm canvas:active { cursor: grabbing; }
.bsm-ui { position: absolute; inset: 0; display: grid; grid-template: auto minmax(0, 1fr) auto / minmax(0, 1fr) auto; gap: 12px; padding: 16px; margin: 0; pointer-events: none; }
.bsm-ui > * { pointer-events: auto; }
.bsm[data-bare] .bsm-ui > :not(.bsm-wipe, .bsm-tag) { visibility: hidden; }
.bsm-card, .bsm-panel, .bsm-dock > *, .bsm-scale { background: var(--face); border: 1px solid var(--line); border-radius: 14px; backdrop-filter: blur(14px); -webkit-backdrop-filter: blur(14px); }
.bsm-card { grid-area: 1 / 1; justify-self: start; align-self: start; max-width: 27rem; padding: 14px 18px 12px; }
.bsm h1 { font-size: 14px; font-weight: 500; margin: 0; color: var(--soft); overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.bsm p { margin: 0; }
.bsm-figures { font-size: clamp(22px, 5.6cqw, 30px); line-height: 1.2; font-weight: 650; letter-spacing: -.02em; white-space: nowrap; }
.bsm-figures:empty { display: none; }
.bsm-figures s { text-decoration: none; color: var(--soft); font-weight: 500; }
.bsm-claim { font-size: 15px; font-weight: 600; color: var(--good); }
.bsm-claim:empty { display: none; }
.bsm summary { cursor: pointer; color: var(--soft); font-size: 13px; list-style-position: inside; }
.bsm-card summary { margin-top: 6px; }
.bsm dl { display: grid; grid-template-columns: auto 1fr; gap: 3px 14px; margin: 6px 0 0; font-size: 13px; }
.bsm dt { color: var(--soft); } .bsm dd { margin: 0; } .bsm dd small { color: var(--soft); font-size: inherit; }
.bsm-tools { grid-area: 1 / 2; display: flex; gap: 6px; align-self: start; justify-self: end; }
.bsm button, .bsm select, .bsm-file { font: inherit; color: inherit; background: var(--face); border: 1px solid var(--line); border-radius: 10px; min-height: 36px; padding: 0 12px; cursor: pointer; }
.bsm button:hover, .bsm-file:hover, .bsm label:hover { color: var(--hot); }
.bsm-tools [aria-expanded=true]:hover, .bsm-seg label:has(:checked):hover { color: var(--on-hot); }
.bsm-tools > * { width: 40px; height: 40px; padding: 0 !important; display: grid; place-items: center; backdrop-filter: blur(14px); }
.bsm-tools [aria-pressed=true], .bsm-tools [aria-expanded=true] { background: var(--hot); color: var(--on-hot); }
.bsm svg { width: 20px; height: 20px; fill: none; stroke: currentColor; stroke-width: 1.7; stroke-linecap: round; stroke-linejoin: round; }
.bsm-file input, .bsm-seg input { position: absolute; opacity: 0; pointer-events: none; }
.bsm-file:has(:focus-visible), .bsm-seg label:has(:focus-visible) { outline: 2px solid var(--hot); outline-offset: 2px; }
.bsm-panel { grid-area: 1 / 2 / 3; margin-top: 52px; width: 18rem; max-height: calc(100% - 52px); overflow: auto; padding: 14px 16px; align-self: start; display: grid; gap: 14px; z-index: 2; }
.bsm-panel h2 { font-size: 13px; font-weight: 600; margin: 0; }
.bsm-panel section { display: grid; gap: 8px; }
.bsm-panel label { display: grid; gap: 2px; } .bsm-panel label.row { grid-template-columns: 1fr auto; align-items: center; gap: 8px; }
.bsm-panel output, .bsm-panel p { color: var(--soft); font-size: 13px; }
.bsm-panel pre { white-space: pre-wrap; font-size: 11px; }
.bsm input[type=range] { width: 100%; accent-color: var(--hot); margin: 4px 0; } .bsm input[type=number] { width: 5rem; font: inherit; }
.bsm-dock { grid-area: 3 / 1 / 4 / 3; display: flex; flex-wrap: wrap; gap: 8px; justify-content: center; align-items: end; pointer-events: none; }
.bsm-dock > * { pointer-events: auto; }
.bsm-seg { display: flex; margin: 0; padding: 4px; min-width: 0; gap: 2px; }
.bsm-seg legend { position: absolute; clip-path: inset(50%); width: 1px; height: 1px; overflow: hidden; }
.bsm-seg label { min-height: 36px; padding: 4px 13px; border-radius: 10px; display: grid; align-content: center; text-align: center; line-height: 1.15; cursor: pointer; position: relative; white-space: nowrap; }
.bsm-seg label small { display: block; font-size: 11.5px; opacity: .9; }
.bsm-seg label:has(:checked) { background: var(--hot); color: var(--on-hot); }
.bsm-seg label:has(:disabled) { opacity: .4; cursor: default; }
.bsm-seg select { border: 0; background: none; min-height: 36px; }
.bsm-seq { flex-basis: 100%; max-width: 46rem; display: grid; grid-template-columns: auto 1fr auto auto; gap: 12px; align-items: center; padding: 6px 14px 6px 6px; }
.bsm-seq button { width: 84px; background: var(--hot); color: var(--on-hot); border: 0; font-weight: 600; } .bsm-seq button:hover { color: var(--on-hot); } .bsm-seq > div { display: flex; gap: 4px; } .bsm-seq button.step { width: 28px; padding: 0; background: none; color: inherit; }
.bsm:has(.bsm-scale:not([hidden])) .bsm-ruler { display: none; } .bsm-ruler { position: absolute; left: 16px; bottom: calc(var(--dock, 62px) + 14px); font-size: 12px; color: var(--soft); pointer-events: none !important; } .bsm-ruler div { height: 6px; border: 1.5px solid currentColor; border-top: 0; margin-top: 2px; }
.bsm kbd { font: inherit; font-weight: 600; color: var(--ink); border: 1px solid var(--line); border-radius: 5px; padding: 0 5px; } .bsm-seg:disabled { opacity: .45; }
.bsm-seq > span:not(.loop) { display: grid; } .bsm-seq svg { width: calc(100% - 16px); height: 26px; margin: 0 8px -4px; fill: var(--hot); fill-opacity: .3; stroke: none; }
.bsm-seq label { display: contents; } .bsm-seq .loop select { border: 0; background: none; padding: 0 4px; } .bsm-seq output { color: var(--soft); font-size: 13px; white-space: nowrap; }
.bsm-seq .loop { display: flex; gap: 6px; align-items: center; font-size: 13px; }
.bsm-scale { grid-area: 2 / 1; align-self: end; justify-self: start; padding: 10px 14px; font-size: 12px; width: 19rem; max-width: 100%; }
.bsm-scale div { height: 10px; border-radius: 5px; margin: 6px 0 3px; } .bsm-scale ol { display: flex; justify-content: space-between; list-style: none; margin: 0; padding: 0; } .bsm-scale li { display: grid; } .bsm-scale li:nth-child(2) { text-align: center; } .bsm-scale li:last-child { text-align: right; } .bsm-scale small { color: var(--soft); }
.bsm-wipe { position: absolute; inset: 0; width: 100% !important; height: 100%; margin: 0 !important; appearance: none; -webkit-appearance: none; background: none; pointer-events: none !important; outline: none; z-index: 0; }
.bsm-wipe::-webkit-slider-runnable-track { height: 100%; } .bsm-wipe::-moz-range-track { height: 100%; background: none; }
.bsm-wipe::-webkit-slider-thumb { -webkit-appearance: none; pointer-events: auto; width: 44px; height: 100cqh; cursor: ew-resize; background: radial-gradient(circle, #fff 13px, #0006 14px, #0000 15px) center 50% / 44px 44px no-repeat, linear-gradient(90deg, #0000 21px, #0005 21px, #fff 21.5px, #fff 22.5px, #0005 23px, #0000 23px); }
.bsm-wipe::-moz-range-thumb { pointer-events: auto; width: 44px; height: 100cqh; border: 0; border-radius: 0; cursor: ew-resize; background: radial-gradient(circle, #fff 13px, #0006 14px, #0000 15px) center 50% / 44px 44px no-repeat, linear-gradient(90deg, #0000 21px, #0005 21px, #fff 21.5px, #fff 22.5px, #0005 23px, #0000 23px); }
.bsm-wipe:focus-visible::-webkit-slider-thumb { filter: drop-shadow(0 0 4px var(--hot)); }
.bsm-tag { position: absolute; bottom: calc(var(--dock, 62px) + 12px); transform: translate(var(--shift), 0); --shift: -50%; pointer-events: none !important; background: var(--face); border: 1px solid var(--line); border-radius: 9px; padding: 3px 10px; font-size: 13px; font-weight: 600; white-space: nowrap; }
.bsm-tag:empty { display: none; }
.bsm[data-bare]::after { content: "H shows the controls"; position: absolute; right: 16px; bottom: 12px; color: var(--soft); animation: bsm-fade 4s forwards; } @keyframes bsm-fade { 60% { opacity: 1; } to { opacity: 0; } }
.bsm-note { position: absolute; left: 50%; bottom: 40%; transform: translateX(-50%); width: min(26rem, calc(100% - 32px)); text-align: center; z-index: 3; }
.bsm-note > * { background: var(--face); border: 1px solid var(--line); border-radius: 14px; padding: 14px 18px; backdrop-filter: blur(14px); }
.bsm [role=alert] { grid-area: 2 / 1; align-self: start; justify-self: start; max-width: 30rem; background: var(--face); border: 1px solid #d9433b; border-left-width: 5px; border-radius: 10px; padding: 10px 14px; z-index: 2; }
.bsm [role=alert]:empty { display: none; }
.bsm progress { width: 100%; height: 8px; margin: 10px 0; accent-color: var(--hot); }
.bsm-drop { position: absolute; inset: 12px; border: 3px dashed var(--hot); border-radius: 20px; display: grid; place-items: center; font-size: 20px; font-weight: 600; background: var(--face); z-index: 5; pointer-events: none !important; }
@container (max-width: 44rem) {
  .bsm-ui { padding: 10px; gap: 8px; grid-template-columns: minmax(0, 1fr) auto; }
  .bsm-card { padding: 8px 12px; border-radius: 12px; } .bsm-claim { font-size: 13px; } .bsm-card summary { margin-top: 2px; }
  .bsm-tools { flex-direction: column; }
  .bsm:has([name=panel][aria-expanded=false]) .bsm-late { display: none; } .bsm-dock { gap: 6px; }
  .bsm-seq { width: 100%; grid-template-columns: auto 1fr auto; } .bsm-seq .loop { grid-area: 2 / 3; } .bsm-seq output { grid-area: 2 / 1 / 3 / 3; white-space: normal; padding-left: 8px; } .bsm-seq > span:not(.loop) { grid-column: 2 / 4; } .bsm-scale { grid-area: 1 / 1; align-self: end; width: 14rem; padding: 6px 12px; }
  .bsm-seg label { padding: 4px 9px; } .bsm-panel { grid-area: 2 / 1 / 3 / 3; width: auto; max-height: 100%; margin: 0; align-self: end; }
}
@container (max-height: 30rem) {
  .bsm-ui { padding: 8px; gap: 6px; } .bsm-card { padding: 6px 12px; max-width: 17rem; } .bsm-figures { font-size: 18px; } .bsm-claim { font-size: 12.5px; } .bsm-card summary { margin-top: 0; }
  .bsm-tools { display: grid; grid-template-columns: auto auto; } .bsm-tools > * { width: 36px; height: 36px; min-height: 0; }
  .bsm:has([name=panel][aria-expanded=false]) .bsm-late { display: none; } .bsm-dock { gap: 6px; } .bsm-seq { flex-basis: auto; flex-grow: 1; }
  .bsm-seg label { min-height: 30px; padding: 2px 9px; } .bsm-seg select { min-height: 30px; }
}
</style>
<div class="bsm-stage" role="region" aria-label="Mesh"><canvas tabindex="0" role="img" aria-label="The mesh. Arrow keys turn it, plus and minus zoom."></canvas></div>
<form class="bsm-ui" aria-label="Viewer">
<input class="bsm-wipe" name="wipe" type="range" min="0" max="1000" value="500" aria-label="Wipe between the two meshes" hidden>
<span class="bsm-tag" data-part="left" aria-hidden="true"></span><span class="bsm-tag" data-part="right" aria-hidden="true"></span>
<header class="bsm-card">
<h1 data-part="name">BSM viewer</h1>
<select name="stream" aria-label="Stream" hidden></select>
<p class="bsm-figures" data-part="figures"></p>
<p class="bsm-claim" data-part="claim"></p>
<details data-part="more" hidden><summary>Measured</summary><dl data-part="facts"></dl></details>
</header>
<div class="bsm-tools" role="toolbar" aria-label="Tools">
<label class="bsm-file" title="Open a mesh or stream, or two to compare"><input name="file" type="file" multiple aria-label="Open a mesh or stream, or two to compare"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M12 16V4m-5 5 5-5 5 5M4 16v4h16v-4"/></svg></label>
<button name="keep" type="button" aria-label="Save the stream" title="Save the stream" hidden><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M12 4v12m-5-5 5 5 5-5M4 16v4h16v-4"/></svg></button>
<button name="picture" type="button" aria-label="Save a picture" title="Save a picture"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M4 8h3l2-3h6l2 3h3v11H4z"/><circle cx="12" cy="13" r="3.5"/></svg></button>
<button name="full" type="button" aria-label="Full screen" title="Full screen (M)"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M4 9V4h5m6 0h5v5m0 6v5h-5m-6 0H4v-5"/></svg></button>
<button name="theme" type="button" aria-label="Dark or light" title="Dark or light"><svg viewBox="0 0 24 24" aria-hidden="true"><circle cx="12" cy="12" r="8"/><path d="M12 4v16a8 8 0 0 0 0-16z" fill="currentColor"/></svg></button>
<button name="keys" type="button" aria-expanded="false" aria-label="Keys" title="Keys (?)"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M8.5 9a3.5 3.5 0 1 1 5.2 3c-1.2.7-1.7 1.3-1.7 2.5"/><path d="M12 18v.01"/></svg></button>
<button name="panel" type="button" aria-expanded="false" aria-label="Settings" title="Settings"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M4 7h9m5 0h2M4 17h2m5 0h9"/><circle cx="15.5" cy="7" r="2.5"/><circle cx="8.5" cy="17" r="2.5"/></svg></button>
</div>
<p data-part="problem" role="alert"></p>
<div class="bsm-ruler" data-part="ruler" hidden><span data-part="length"></span><div></div></div>
<div class="bsm-scale" data-part="scale" hidden><span data-part="legend"></span><div></div><ol></ol></div>
<div class="bsm-panel" data-part="panel" role="region" aria-label="Settings" hidden>
<section><h2>View</h2>
<label>Light from <input name="light" type="range" min="-180" max="180" value="0"></label>
<label class="row">Background <select name="back"><option value="">default</option><option value="white">white</option><option value="gray">gray</option><option value="black">black</option></select></label>
<label class="row">Auto-rotate <input name="spin" type="checkbox"></label>
</section>
<section data-part="arrival"><h2>Arrival of the stream</h2>
<p data-part="status" role="status" aria-live="polite"></p>
<label>Stop after byte <input name="cut" type="range" min="0" max="1" value="1" step="1"><output data-part="bytes"></output></label>
<label class="row">Bandwidth, Mbit/s (0: unlimited) <input name="rate" type="number" min="0" step="any" value="0"></label>
<button name="again" type="button">Stream again</button>
<p data-part="times"></p>
</section>
<details><summary>Licenses</summary><pre data-part="licenses"></pre></details>
</div>
<div class="bsm-panel" data-part="keys" role="region" aria-label="Keys" tabindex="0" hidden>
<section><h2>Keys</h2><dl>
<dt><kbd>1</kbd> <kbd>2</kbd> <kbd>3</kbd></dt><dd>choose a mesh</dd><dt><kbd>W</kbd></dt><dd>wipe, or one mesh</dd><dt><kbd>S</kbd></dt><dd>side by side, or one mesh</dd>
<dt><kbd>F</kbd></dt><dd>fit the mesh to the page; double click does, too</dd><dt><kbd>M</kbd></dt><dd>full screen</dd><dt><kbd>D</kbd></dt><dd>smooth, flat, wireframe</dd><dt><kbd>,</kbd> <kbd>.</kbd></dt><dd>one frame back or on; space plays</dd><dt><kbd>E</kbd></dt><dd>error colors</dd><dt><kbd>L</kbd></dt><dd>move the light</dd><dt><kbd>T</kbd></dt><dd>auto-rotate</dd>
<dt><kbd>H</kbd></dt><dd>hide or show the controls</dd><dt><kbd>?</kbd></dt><dd>these keys</dd><dt>on the mesh</dt><dd>arrows turn, <kbd>+</kbd> and <kbd>-</kbd> zoom; drag, wheel, pinch</dd>
</dl></section>
</div>
<div class="bsm-dock">
<div class="bsm-seq" data-part="sequence" role="group" aria-label="Sequence" hidden>
<div><button name="play" type="button">Play</button><button name="earlier" type="button" class="step" aria-label="One frame back" title="One frame back (,)">‹</button><button name="later" type="button" class="step" aria-label="One frame on" title="One frame on (.)">›</button></div>
<span><svg data-part="errors" viewBox="0 0 1 1" preserveAspectRatio="none" role="img" aria-label="Largest error of each frame" hidden><title>Largest error of each frame</title><path/></svg><input name="frame" type="range" min="0" max="0" value="0" step="1" aria-label="Frame"></span>
<output data-part="time"></output>
<span class="loop"><select name="speed" aria-label="Speed"><option value="0.25">¼ ×</option><option value="0.5">½ ×</option><option value="1" selected>1 ×</option><option value="2">2 ×</option></select><label><input name="loop" type="checkbox" checked> Loop</label></span>
</div>
<fieldset class="bsm-seg" data-part="layers" hidden><legend>Mesh</legend></fieldset>
<fieldset class="bsm-seg" data-part="modes" hidden><legend>Compare</legend>
<label><input type="radio" name="mode" value="one">Single</label><label><input type="radio" name="mode" value="wipe">Wipe</label><label><input type="radio" name="mode" value="split">Side by side</label></fieldset>
<fieldset class="bsm-seg bsm-late"><legend>Shading</legend>
<label><input type="radio" name="shading" value="smooth" checked>Smooth</label><label><input type="radio" name="shading" value="flat">Flat</label><label><input type="radio" name="shading" value="wire">Wireframe</label></fieldset>
<div class="bsm-seg bsm-late" data-part="colors"><select name="color" aria-label="Color">
<option value="plain">Clay</option><option value="own">Own colors</option><option value="error">Error colors</option><option value="blocks">Blocks</option><option value="refined">Refinement</option>
</select></div>
</div>
<div class="bsm-note" data-part="work" hidden><div><p data-part="stage" role="status"></p><progress max="1"></progress><button name="cancel" type="button">Cancel</button></div></div>
<div class="bsm-note" data-part="invite" hidden><div><p><b>Drop a mesh here</b>, or two to compare them. Or <label class="bsm-file" style="padding:2px 10px">open them<input name="file" type="file" multiple></label></p><p>It is encoded on this computer; nothing leaves it.</p><label>Preset <select name="preset"><option>small</option><option selected>balanced</option><option>fine</option><option>near-lossless</option></select></label></div></div>
<div class="bsm-drop" data-part="drop" hidden>Drop to open it; nothing leaves this computer</div>
</form>
`;var kx=12,zx=120,sf=480;function Gx(i){if(!i)return[[0,0,0],1];let{center:e,scale:t,grid:n,lattice:s}=i;if(n.length===0)return[e,t];let r=s.length>0?t*s[0]/s[1]:t;return[e.map((a,o)=>a+r*n[o]/2),r*Math.max(Math.hypot(...n),1)]}var Ir=class{constructor(e,t,n,s,r=[]){this.root=e;this.pool=t;this.content={name:"",main:0,layers:[],facts:{}};this.geometry=new Xi;this.losses=[];this.missed=0;this.over=!0;this.closed=!1;this.choose=()=>this.restart();this.turns=0;this.fitted=1;this.watch=new ResizeObserver(()=>this.meshes.place());e.classList.add("bsm"),e.innerHTML=nf,this.form=new Ho(e),this.form.say("licenses",n),r.length>0&&this.form.control("preset").replaceChildren(...r.map(l=>new Option(l)));try{this.stage=new jo(e.querySelector("canvas"))}catch(l){throw this.fail(`WebGL is not available. ${l instanceof Error?l.message:l}`),l}this.arrival=new zo(this.form),this.meshes=new Vo(this.form,this.stage),this.sequence=new qo(this.form);let a=(l,c)=>{this.turn(),this.open(l),this.receive(c),this.finish()};this.upload=new Kr(this.form,a,s),this.listen();for(let l of[e,...e.querySelectorAll(".bsm-card, .bsm-dock, .bsm-scale")])this.watch.observe(l);let o=l=>{this.closed||(this.step(l),requestAnimationFrame(o))};requestAnimationFrame(o)}offer(e,t){let n=this.form.control("stream");this.choose=t,e.forEach((s,r)=>n.add(new Option(s,String(r)))),this.form.part("name").hidden=e.length>1,n.hidden=e.length<2,this.form.part("invite").hidden=e.length>0,e.length===0&&(this.root.dataset.state="empty")}turn(){let e=++this.turns;return()=>e===this.turns}open(e,t=-1){let{form:n}=this,s=n.control("stream");s.selectedIndex=t,n.part("name").hidden=t>=0&&s.length>1,n.say("name",e.name),n.part("invite").hidden=!0,n.part("arrival").hidden=n.part("colors").hidden=e.tiles!==void 0,n.control("keep").hidden=e.facts.seconds===void 0,this.content=e,this.alone=void 0,this.arrival.clear(),this.meshes.open(e),this.restart(),this.headline()}async openTiles(e,t){this.open(e,t),this.over=!0;let n=await Go.open(e.tiles,this.pool,()=>this.looked="");if(this.closed||this.content!==e||this.tiles)return n.close();this.tiles=n}receive(e){this.arrival.receive(e)}finish(){this.arrival.whole=!0}fail(e){this.over=!0,this.form.say("problem",e),this.root.dataset.state="failed"}close(){this.closed=!0,this.watch.disconnect(),this.upload.cancel(),this.decoding?.close(),this.tiles?.close(),this.stage.dispose()}listen(){let{form:e,meshes:t,root:n,stage:s}=this;e.on("stream","change",({value:r})=>this.choose(Number(r))),e.on("light","input",({value:r})=>s.light=Number(r)),e.on("spin","change",({checked:r})=>s.camera.controls.autoRotate=r),e.on("back","change",({value:r})=>n.dataset.back=r),e.on("again","click",()=>this.restart()),e.on("theme","click",()=>{let r=n.dataset.theme?n.dataset.theme==="dark":matchMedia("(prefers-color-scheme: dark)").matches;n.dataset.theme=r?"light":"dark"});for(let r of["panel","keys"])e.on(r,"click",()=>e.unfold(r));e.on("full","click",()=>{document.fullscreenElement?document.exitFullscreen():n.requestFullscreen()}),e.on("picture","click",()=>Nd(s,t.captions).toBlob(r=>r&&this.save(r,"png"))),e.on("keep","click",()=>this.save(new Blob([this.arrival.bytes]),"bsm")),n.querySelector("form").addEventListener("submit",r=>r.preventDefault()),Vd(e,s,t),matchMedia("(min-width: 45rem) and (min-height: 30rem)").matches&&e.part("more").setAttribute("open","")}save(e,t){let n=`${this.content.name.replace(/\.\w+$/,"")||"mesh"}.${t}`,s=Object.assign(document.createElement("a"),{href:URL.createObjectURL(e),download:n});s.click(),setTimeout(()=>URL.revokeObjectURL(s.href),6e4)}walk(e){let{form:t,root:n,stage:s}=this,{eye:r,camera:{pixels:a}}=s,o=[...r,a].join();if(o===this.looked)return;let l=this.looked===void 0;this.looked=o,l?s.place(e.extent.center,e.extent.diagonal):e.look(r,a);let c=e.shown;s.show(0,...c);let h=c.reduce((g,b)=>g+b.getIndex().count/3,0),{shards:d,levels:u}=e.manifest;t.say("figures",`${zn(d.reduce((g,{size:b})=>g+b,0))} in ${u.length} levels`),t.say("claim",`${zn(e.got)} fetched for this view`);let f=`${mn(h)} triangles in ${c.length} tile${c.length===1?"":"s"}`;this.listRows([["Shown",f],["Fetched",`${mn(e.there)} tiles`]]),t.say("problem",e.problem),n.dataset.tiles=String(c.length),n.dataset.faces=String(h),n.dataset.state=e.complete?e.problem?"damaged":"complete":"loading",l?this.looked="":!this.meshes.shown&&c.length>0&&(this.meshes.shown=!0,s.fill(c.map(g=>g.getAttribute("position").array)),s.shadow(...c))}restart(){let{meshes:e,root:t}=this;this.decoding?.close(),this.tiles?.close(),this.tiles=this.looked=void 0;let n=new Xi({onConnectivity:()=>e.stale=!0,onBlock:()=>this.drawn(),onFrame:()=>this.sequence.begin(n)});this.geometry=n,e.begin(n),this.sequence.open(this.content.facts),this.arrival.restart(),this.losses=[],this.missed=0,this.track=void 0,this.fitted=1,this.over=!1,this.form.say("problem",""),t.dataset.state="loading",this.decoding=this.pool.open({onPicture:s=>{n.accept(s),s.type==="loss"&&this.lose(s),s.type==="end"&&this.end()},onError:s=>this.fail(`This stream cannot be decoded further. ${s.name}: ${s.message}`),onTaken:s=>{t.dataset.taken=String(s),s===this.arrival.fed&&this.show()}},{tolerant:!0,drawing:"growing"})}step(e){let{arrival:t,geometry:n,meshes:s,over:r,stage:a}=this;if(a.step(),this.sequence.step(e,r,this.missed)&&(!r&&n.frames.length>=2*this.fitted&&this.fill(),s.seek(n.shown),this.track&&a.follow(this.track.at(n.shown)),r&&a.shadow(n),s.stale=!0),this.measure(),s.stale&&s.recolor(),this.tiles)return this.walk(this.tiles);t.isCut&&this.restart(),t.feed(this.decoding,this.over),t.report(this.geometry,this.missed)}show(){let{header:e}=this.geometry;this.closed||this.meshes.show(this.geometry,...Gx(e))}lose(e){if(this.content.live&&e.frames?.first===0){this.missed=e.frames.count;return}this.losses.push(e);let t=this.losses.flatMap(({block:l})=>l===void 0?[]:[l]),n=this.losses.reduce((l,{frames:c})=>l+(c?.count??0),0),s=[t.length>0?`block${t.length>1?"s":""} ${t.join(", ")}`:"",n>0?`${n} frames`:""],{name:r,message:a}=ri(this.losses[0].error),o=s.filter(Boolean).join(" and ")||"some bytes";this.form.say("problem",`This stream is damaged: ${o} cannot be decoded, the rest is shown. First, ${r}: ${a}`)}drawn(){this.arrival.first??=this.arrival.passed,this.show(),this.meshes.stale=!0}end(){let{arrival:e,geometry:t,meshes:n,stage:s}=this;this.over=n.stale=!0,e.complete=e.passed,this.fill(),t.getIndex()&&s.shadow(t),this.headline();let r=a=>this.form.say("problem",`The original cannot be compared. ${a instanceof Error?a.message:a}`);(n.accompanied?n.dress():this.accompany()).catch(r),this.root.dataset.state=this.losses.length>0?"damaged":"complete"}fill(){let{geometry:e,stage:t}=this,{frames:n}=e;this.fitted=Math.max(n.length,1),this.track=n.length>1?new Qo(n.map(({positions:o})=>o),e.frameRate):void 0;let s=Math.ceil(n.length/kx),r=n.map((o,l)=>l).filter(o=>o%s===0),a=r.length>0?r.map(o=>n[o].positions):[e.getAttribute("position")?.array??[]];t.fill(a,Bo(e.metadata),e.getAttribute("normal"),this.track&&r.map(o=>this.track.at(o)))}measure(){let{form:e,geometry:t,meshes:n,root:s,stage:r}=this,a=e.part("ruler");if(a.hidden=!n.shown||s.clientWidth<sf||s.clientHeight<sf,a.hidden)return;let o=zx*r.pixel,l=10**Math.floor(Math.log10(o)),c=l*[5,2,1].find(d=>d*l<=o),h=t.metadata.get("unit");e.say("length",`${Number(c.toPrecision(1))} ${typeof h=="string"?h:""}`.trim()),a.style.width=`${Math.round(c/r.pixel)}px`}async accompany(){let{arrival:e,content:t,meshes:n,pool:s}=this,r=()=>this.content===t&&!this.closed;if(n.accompanied=!0,await n.accompany(s,r),!!r()&&(this.sequence.plot(t.facts),this.headline(),t.layers.length>1&&e.whole&&this.geometry.frames.length===0)){let a=performance.now();if((await Rr(s,e.bytes.slice())).dispose(),!r())return;this.alone=performance.now()-a,this.headline()}}headline(){let{alone:e,arrival:t,content:n,form:s,geometry:r}=this;if(n.tiles)return;let a=Dd(n,t.length,r,e??t.complete),o=a.plain===void 0?[]:[An("s",`${zn(a.plain)} → `)];s.part("figures").replaceChildren(...o,a.size>0?zn(a.size):""),s.say("claim",a.claim),this.listRows(a.rows)}listRows(e){let t=n=>n?[An("small",` ${n}`)]:[];this.form.part("more").hidden=e.length===0,this.form.part("facts").replaceChildren(...e.flatMap(([n,s,r])=>[An("dt",n),An("dd",s,...t(r))]))}};var rf=2**26,Vx=["14 bits","12 bits","16 bits","lossless"];async function*of({body:i}){let e=i.getReader();try{for(let t;!(t=await e.read()).done;)yield t.value}finally{e.cancel().catch(()=>{})}}var Hx=async(i,e,t,n)=>{let s=new Blob(i);if(s.size>rf)throw new Error(`More than ${rf>>20} MiB; use bsm encode, bsm tile, or bsm view --original.`);let r=new URLSearchParams([["preset",e],["first",`${i[0].size}`],...i.map(({name:l})=>["name",l])]),a=new TextDecoder,o="";for await(let l of of(await Zr(`upload?${r}`,{method:"POST",body:s,signal:n}))){o+=a.decode(l,{stream:!0});for(let c;(c=o.indexOf(`
`))>=0;o=o.slice(c+1)){let{stage:h,share:d,error:u,entry:f}=JSON.parse(o.slice(0,c));if(u)throw new Error(u);if(f)return f;t(h,d)}}throw new Error("The server has stopped.")};function Wx(i,e,t){let n=new Worker(Os,{type:"module",name:"BSM encoder"});return new Promise((s,r)=>{t.addEventListener("abort",()=>r(t.reason),{once:!0}),n.onerror=({message:a})=>r(new Error(a||"The encoder cannot be loaded.")),n.onmessage=({data:a})=>"error"in a?r(new Error(a.error)):"stage"in a?e(a.stage,a.share):s(a),n.postMessage(i)}).finally(()=>n.terminate())}var Xx=async(i,e,t,n)=>{let[s,r,a]=[performance.now(),[],{notes:[],less:!1}];for(let o of i){if(Bs(o)){r.push(await pl(o));continue}let{original:l,stream:c,notes:h,less:d}=await Wx({file:o,preset:i.length>1?"lossless":e},t,n);if(r.push(c),a.notes.push(...h.map(f=>i.length>1?`${o.name}: ${f}`:f)),a.less||=d,i.length>1)continue;let u=[{title:"Original",detail:"",size:o.size,bytes:l},{title:"BSM",detail:e,size:c.length,bytes:c}];return{name:o.name,main:1,layers:u,facts:{...a,seconds:(performance.now()-s)/1e3}}}return ml(i,r,a)};async function qx(i){let e=JSON.parse(i.textContent),t=new Fs(fl),n=new Ir(document.body,t,`three

The MIT License

Copyright © 2010-2026 three.js authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE.


fzstd

MIT License

Copyright (c) 2020 Arjun Barrett

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.`,Os?Xx:Oh?Hx:void 0,Os?Vx:void 0),s=async r=>{let a=n.turn(),o=e[r];try{if(await t.preload().catch(()=>{}),!a())return;if(o.tiles!==void 0)return await n.openTiles(o,r);let{url:l}=o.layers[o.main],c=l===void 0?[await Xn(o.layers[o.main])]:of(await Zr(l));a()&&n.open(o,r);for await(let h of c){if(!a())return;n.receive(h)}a()&&n.finish()}catch(l){a()&&n.fail(`${o.name} could not be fetched. ${l instanceof Error?l.message:l}`)}};n.offer(e.map(({name:r})=>r),s),e.length>0&&await s(0)}async function Yx({model:i,el:e}){let t=e.appendChild(document.createElement("div"));t.style.height=`${i.get("height")}px`;let n=new Ir(t,new Fs(fl),`three

The MIT License

Copyright © 2010-2026 three.js authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE.


fzstd

MIT License

Copyright (c) 2020 Arjun Barrett

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.`),s=async()=>{let r=i.get("content");n.open(r),n.receive(await Xn(r.layers[r.main])),n.finish()};return i.on("change:content",s),await s(),()=>{i.off("change:content",s),n.close()}}var GA={render:Yx},af=document.getElementById("bsm-streams");af&&qx(af);export{GA as default};
