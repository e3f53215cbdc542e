var Df=Object.defineProperty;var et=(i,e,t)=>()=>{if(t)throw t[0];try{return i&&(e=i(i=0)),e}catch(n){throw t=[n],n}};var th=(i,e)=>{for(var t in e)Df(i,t,{get:e[t],enumerable:!0})};var lh={};th(lh,{BsmError:()=>Tn,CorruptError:()=>Ie,DEFAULT_LIMITS:()=>Nf,Decoder:()=>Uf,END_OF_STREAM:()=>Ff,FormatError:()=>Or,Helper:()=>sh,Kernels:()=>Of,LimitError:()=>Ei,NEED_BLOCK:()=>rh,NEED_DATA:()=>Bf,NumericError:()=>Br,Team:()=>ah,TruncatedError:()=>Ai,UnsupportedError:()=>dn,bsm:()=>Fr,checkLimit:()=>oh,decode:()=>kf,errorLike:()=>qi,hasVectors:()=>zf,openDesk:()=>rl,serve:()=>Vf});var nh,Fr,Tn,Ie,Nf,Uf,Ff,Or,sh,Of,Ei,rh,Bf,Br,ah,Ai,dn,oh,kf,qi,zf,rl,Vf,xt=et(()=>{nh=function(){var e=class extends Error{constructor(m,b={}){super(m),this.problem=m,this.name="BsmError",this.place={},this.located(b)}get described(){return{name:this.name,problem:this.problem,place:this.place}}located(m){this.place.offset??=m.offset,this.place.frame??=m.frame,this.place.block??=m.block;let{offset:b,frame:E,block:C}=this.place,D=this.problem||"this stream is wrong; bsm.js says how",k=[["byte",b],["frame",E],["block",C]].flatMap(([B,q])=>q===void 0?[]:[`${B} ${q}`]);return this.message=k.length?`${D} [${k.join(", ")}]`:D,this}},t=class extends e{constructor(){super(...arguments),this.name="FormatError"}},n=class extends e{constructor(){super(...arguments),this.name="UnsupportedError"}},s=class extends e{constructor(){super(...arguments),this.name="CorruptError"}},r=class extends e{constructor(){super(...arguments),this.name="TruncatedError"}},a=class extends e{constructor(){super(...arguments),this.name="LimitError"}},o=class extends e{constructor(){super(...arguments),this.name="NumericError"}},l=[t,n,s,r,a,o];function c({name:m,problem:b,place:E}){let C=l.find(D=>new D("").name===m)??e;return new C(b,E)}var h={vertices:16777216,faces:33554432,blocks:131072,blockSize:8192,coefficients:4096,frames:1048576,gopFrames:1024,frameBytes:268435456,metadataBytes:8388608,attributes:255,attributeValues:268435456,sequenceBytes:2147483648,work:8e8,workPerVertex:32e3,workPerByte:16e3,memoryPerByte:64,blockMemory:67108864,blockMemoryPerVertex:1024},d={...h,keptBytes:2**30,memory:2**31};function u(m,b,E){if(E>m[b])throw new a(`${b} = ${E} is over the limit of ${m[b]}; raise it if you trust the source`)}var f=class ih{constructor(b){this.module=b}static async compile(b){return new ih(await WebAssembly.compile(b))}borrow(){let b=this.waiting??new WebAssembly.Instance(this.module).exports;return this.waiting=void 0,b}take(b){b.memory.buffer.byteLength<=16777216&&(this.waiting=b)}};function _(){return globalThis.navigator?.hardwareConcurrency??1}function M(){let m=[0,97,115,109,1,0,0,0,1,5,1,96,0,1,123,3,2,1,0,10,8,1,6,0,65,0,253,15,11];return WebAssembly.validate(Uint8Array.from(m))}var p=["generic","color","normal","texcoord"],g=["vertex","corner","face"],S=["uint8","int8","uint16","int16","uint32","int32","float32","float64"],[P,w,I,R,y,T,X,F,V,$,Q,U,,J]=Array.from({length:14},(m,b)=>b),se={3:"Format",4:"Corrupt",5:"Unsupported",6:"Limit",7:"Numeric",8:"Limit",12:"Truncated"},Z=[Uint8Array,Int8Array,Uint16Array,Int16Array,Uint32Array,Int32Array,Float32Array,Float64Array],[he,K,oe]=[1,2,3],le=new TextDecoder("utf-8",{ignoreBOM:!0}),Re=255,[ke,ne]=[48,56],ve=31,Me=class{constructor(m,b,E,{number:C,among:D}={number:0,among:0}){this.kernels=m,this.exports=m.borrow();let k={...d,...b},B=[k.vertices,k.faces,k.blocks,k.blockSize,k.coefficients,k.frames,k.gopFrames,k.frameBytes,k.metadataBytes,k.attributes,k.attributeValues,k.sequenceBytes,k.memory,k.work,k.workPerVertex,k.workPerByte,1/0,k.blockMemory,k.blockMemoryPerVertex,k.memoryPerByte,1/0,k.memory];if(!this.t(8*B.length,q=>(new Float64Array(this.buffer,q).set(B),this.call("page_open",q,E?1:0,C,D))))throw new a("this machine has no memory for a decoder")}push(m){m.length!==0&&this.t(m.length,b=>{new Uint8Array(this.buffer,b).set(m),this.call("page_push",b,m.length)})}finish(){this.call("page_finish")}share(m){this.call("page_share",m)}next(){let m=this.call("page_next"),b=new DataView(this.buffer,m),[E,C,D,k]=[8,16,24,32].map(B=>Number(b.getBigInt64(B,!0)));return{type:b.getInt32(0,!0),index:E,count:C,vertices:D,faces:k}}error(m=!1){let b=this.call("page_error",m?1:0),E=new DataView(this.buffer,b),[C,D,k]=[8,16,24].map(B=>Number(E.getBigInt64(B,!0))).map(B=>B<0?void 0:B);return c({name:`${se[E.getInt32(0,!0)]??"Bsm"}Error`,problem:this.text(b+32),place:{offset:C,frame:D,block:k}})}get state(){let[m,b,E]=this.doubles(this.call("page_state"),3);return[m,b,E]}header(){let m=this.doubles(this.call("page_header"),ve+8),b=(ue,Se,qe)=>ue>0?[...m.subarray(Se,qe)]:[],[E,C,D,k,B,q,ae,te]=m.subarray(ve);return{vertices:m[0],faces:m[1],blocks:m[2],blockSize:m[3],coefficients:m[4],keyInterval:m[5],step:m[6],scale:m[7],smoothing:m[8],attributes:m[9],light:m[10],frames:m[11],gopFrames:m[12],run:m[13],again:m[14]<0?void 0:m[14],center:b(1,15,18),refinement:b(m[18],19,21),grid:b(m[21],22,25),lattice:b(m[25],25,27),corner:b(m[27],28,31),paper:{bits:E,coarser:C,exact:D,power:k,iterations:B,keyIterations:q,shift:ae,springs:te}}}metadata(m,b){let E=new Map;return this.t(ke,C=>{for(let D=m;D<b;D++){this.call("page_metadata",D,C);let k=new DataView(this.buffer,C),B=k.getInt32(4,!0),q=this.f(k.getUint32(24,!0),k.getUint32(28,!0)),ae=k.getBigInt64(8,!0),te=ae>=-(2n**31n)&&ae<2n**32n?Number(ae):ae,ue=B===he?te:B===K?k.getFloat64(16,!0):B===oe?le.decode(q):q;E.set(this.text(k.getUint32(0,!0)),ue)}}),E}faces(m){return this.i(Int32Array,3*m.faces,(b,E)=>this.call("page_faces",b,E))}loose(){let{vertices:m,positions:b}=this.d("page_loose");return{vertices:m,positions:b}}positions(m){return this.i(Float64Array,3*m,(b,E)=>this.call("page_positions",b,E))}changes(){return this.d("page_changes")}d(m){let[b,E,C,D]=this.rows(m);return{vertices:this.ints(E,b),positions:this.doubles(C,3*b),final:this.f(D,b)}}losses(){let[m,b,E,C]=this.rows("page_losses");return{missing:this.ints(b,m),degraded:this.ints(E,this.doubles(C,1)[0])}}attribute(m,b=!1){return this.t(ne,E=>{if(this.call("page_attribute",m,E)!==0)return;let C=new DataView(this.buffer,E),[D,k,B,q]=[4,8,12,16].map(it=>C.getInt32(it,!0)),[ae,te]=[24,32].map(it=>Number(C.getBigInt64(it,!0)));if(b&&C.getInt32(40,!0)===0)return;let ue=this.text(C.getUint32(0,!0)),Se=this.i(Z[B],ae*q,(it,Ye)=>this.call("page_values",m,it,Ye*Z[B].BYTES_PER_ELEMENT)),qe=te>0?this.i(Int32Array,te,(it,Ye)=>this.call("page_indices",m,it,Ye)):void 0;return{name:ue,semantic:p[k],domain:g[D],kind:S[B],components:q,values:Float64Array.from(Se),indices:qe}})}attributes(m=!1){return Array.from({length:Re+1},(b,E)=>this.attribute(E,m)).filter(b=>b!==void 0)}handed(m){let[b,E,C,D]=this.rows("page_handed");return{index:m,block:{vertices:new Int32Array(this.buffer,E,b).slice(),positions:this.doubles(C,3*b),weights:this.doubles(D,b)}}}add({index:m,block:b}){if(!b)return void this.call("page_lose",m);let[,E,C,D]=this.rows("page_room",b.vertices.length);if(new Int32Array(this.buffer,E).set(b.vertices),new Float64Array(this.buffer,C).set(b.positions),new Float64Array(this.buffer,D).set(b.weights),!this.call("page_add",m))throw new RangeError("a block that is none of this mesh")}release(){let{exports:m}=this;m&&(this.call("page_close"),this.kernels.take(m),this.exports=void 0)}get own(){if(!this.exports)throw new Error("this decoder was released");return this.exports}get buffer(){return this.own.memory.buffer}call(m,...b){let{own:E}=this;try{return E[m](...b)>>>0}catch(C){throw this.exports=void 0,C}}rows(m,...b){let E=this.call(m,...b);if(E===0)throw this.error();return new Uint32Array(this.buffer,E,4).slice()}ints(m,b){return new Int32Array(this.buffer,b>0?m:0,b).slice()}doubles(m,b){return new Float64Array(this.buffer,b>0?m:0,b).slice()}f(m,b){return new Uint8Array(this.buffer,m,b).slice()}text(m){let b=new Uint8Array(this.buffer,m);return le.decode(b.slice(0,b.indexOf(0)))}t(m,b){let E=this.call("page_take",m);if(E===0)throw new a(`this machine has no ${m} bytes of memory for the decoder`);try{return b(E)}finally{this.exports&&this.call("page_give",E,m)}}i(m,b,E){return this.t(Math.max(1,b)*m.BYTES_PER_ELEMENT,C=>{if(E(C,b)!==0)throw this.error();return new m(this.buffer,C,b).slice()})}},Pe="need data",_e="end of stream",Ue="need block",dt=class{constructor(m,b={},E={}){this.wishes=E,this.y=[],this.metadata=0,this.b=!1,this.r={attributes:[],faces:new Int32Array(0)},this.shared=new Map,this.engine=new Me(m,b,E.tolerant??!1)}receiveData(m){this.engine.push(m)}receiveEof(){this.engine.finish()}receiveBlock(m){this.shared.set(m.index,m)}get position(){return this.engine.state[0]}get work(){return this.engine.state[1]}get vertices(){return this.engine.state[2]}nextEvent(){return this.next(!this.wishes.whole)}release(){this.engine.release()}finish(){return this.advance()}advance(){let{r:m}=this;this.receiveEof();for(let b;(b=this.next(!1))!==_e;){if(b===Ue)return b;if(!(typeof b=="string"||m.first)){if(b.type==="connectivity"&&(m.faces=b.faces),b.type==="attribute"&&m.attributes.push(De(b)),b.type==="frame"){let{positions:E,attributes:C}=b,D=m.attributes.map(k=>C.find(({name:B})=>B===k.name)??k);m.first={positions:E,faces:m.faces,attributes:D}}b.type==="end"&&(m.first={positions:b.positions??new Float64Array(0),faces:m.faces,attributes:m.attributes})}}return m.first}next(m){if(this.error)throw this.error;try{for(;;){let b=this.y.shift()??(this.s===void 0?this.x(this.engine.next(),m):this.received(this.s,m));if(b)return b}}catch(b){throw b instanceof e&&(this.error=b),b}}x(m,b){let{engine:E,wishes:C}=this,{type:D,index:k,count:B,vertices:q}=m;if(D===P)return Pe;if(D===Q)return _e;if(D===U)throw E.error();if(D===J&&(this.s=k),D===w)return this.I(E.header());if(D===I){let ue=E.metadata(this.metadata,k);return this.metadata=k,{type:"metadata",entries:ue}}if(D===R){let[ue,Se]=[E.faces(m),E.loose()];return this.b&&this.y.push(...E.attributes().map(qe=>({type:"attribute",...qe}))),{type:"connectivity",faces:ue,vertices:q,loose:Se}}if(b&&(D===y||D===T))return this.g(D===y?k:void 0);if(D===X)return{type:"attribute",...E.attribute(k)};if(D===F)return{type:"frame",index:k,positions:E.positions(q),attributes:E.attributes(!0)};if(D===V){let ue=this.header.gopFrames>0&&k>=0;return{type:"loss",block:ue||k<0?void 0:k,...ue?{frames:{first:k,count:B}}:{},error:E.error(!0).described}}if(D!==$)return;let ae=this.header.gopFrames===0,te={type:"end",...C.tolerant&&ae?E.losses():{missing:new Int32Array(0),degraded:new Int32Array(0)}};return!b&&ae?{...te,positions:E.positions(q)}:te}I(m){let{wishes:b,engine:E}=this;this.header=m,this.b=m.again!==void 0;let C=m.run>0?0:b.helpers?.(m)??0;return E.share(C>0?C+1:0),{type:"header",header:m}}g(m){let b=this.engine.changes();return m===void 0?{type:"refinement",...b}:{type:"block",index:m,...b}}received(m,b){let E=this.shared.get(m);if(!E)return Ue;this.shared.delete(m),this.s=void 0;let{problem:C}=E;if(C&&(!this.wishes.tolerant||this.header.gopFrames>0))throw c(C);return this.engine.add(E),C?{type:"loss",block:m,error:C}:b?this.g(m):void 0}};function De({type:m,...b}){return b}function je(m,b,E={}){let C=new dt(m,E);try{return C.receiveData(b),C.finish()}finally{C.release()}}var nt=class{constructor(m,b,E={},C=!1){this.v=!1,this.over=!1,this.engine=new Me(m,E,C,b)}receiveData(m){this.over||this.engine.push(m)}receiveEof(){this.over||this.engine.finish()}release(){this.engine.release()}nextBlock(){let{engine:m}=this;for(;!this.over;){let{type:b,index:E}=m.next();if(b===P)return Pe;if(b===y)return m.handed(E);if(b===V&&E>=0)return{index:E,problem:m.error(!0).described};if(b===w&&(this.over=this.v,this.v=!0),(b===Q||b===U)&&(this.over=!0),b===U){let C=m.error().described;if(C.place.block!==void 0)return{index:C.place.block,problem:C}}}return _e}};function Xe({keyInterval:m,blocks:b},E){return Math.floor(E/(m||b))}var Et=3,vt=8192;function Lt(m,b=vt){return m.vertices<b?0:Math.max(0,Math.min(Xe(m,m.blocks-1)+1,_(),Et+1)-1)}var at=class{constructor(m,b=vt){this.worthwhile=b,this.task=0,this.w=0,this.last=Promise.resolve(),this.members=[...m];for(let E of m)E.onmessage=({data:C})=>this.hear(C),E.onerror=({message:C})=>this.fail(C??"a helper could not be started")}begin(m,b,E){let C=1+Math.min(b,this.members.length);for(let D of this.members)this.say(D,{task:this.task,stop:!0});return this.listener=E,this.task++,this.w=C-1,this.members.forEach((D,k)=>{k+1<C&&this.say(D,{task:this.task,start:{...m,share:{number:k+1,among:C}}})}),C-1}receiveData(m){for(let b of this.members)this.say(b,{task:this.task,data:m})}receiveEof(){for(let m of this.members)this.say(m,{task:this.task,data:null})}decode(m,b,E={}){let C=this.last.then(()=>this.S(m,b,E));return this.last=C.catch(()=>{}),C}close(){for(let m of this.members)this.say(m,{task:this.task,stop:!0}),m.terminate?.(),m.close?.();this.members.length=0}async S(m,b,E){let C=[],D=!1,k=()=>{},B=ue=>{C.push(ue),k()},q=()=>{D=!0,k()},ae=ue=>{let Se=this.begin({kernels:m.module,limits:E},Lt(ue,this.worthwhile),{onBlock:B,onOver:q});return Se>0&&this.receiveData(b),Se},te=new dt(m,E,{helpers:ae});for(te.receiveData(b);;){let ue=te.advance();if(ue!==Ue)return ue;for(;C.length===0&&!D;)await new Promise(Se=>k=Se);if(C.length===0)return je(m,b,E);for(let Se of C.splice(0))te.receiveBlock(Se)}}say(m,b){m.postMessage(b,[])}hear(m){!("task"in m)||m.task!==this.task||("fault"in m?this.fail(m.fault):"shared"in m?this.listener?.onBlock(m.shared):("through"in m||"problem"in m)&&--this.w===0&&this.listener?.onOver("all helpers are through"))}fail(m){this.close(),this.listener?.onOver(m)}};function un(m){if(m===void 0)throw new RangeError("a stage of the decoder is asked for what it has not begun");return m}function pt(m,b,E){if(!E)return new Float32Array(m);let C=new Float32Array(b*E.length);for(let D=0;D<E.length;D++)for(let k=0;k<b;k++)C[b*D+k]=m[b*E[D]+k];return C}function $t(m,b){let E=new Int32Array(b+1);for(let k of m)k>=0&&E[k+1]++;for(let k=0;k<b;k++)E[k+1]+=E[k];let C=new Int32Array(E[b]),D=E.slice();return m.forEach((k,B)=>k>=0&&(C[D[k]++]=B)),{starts:E,members:C}}function Zt(m){let b=new Int32Array(m);for(let E=0;E<m;E++)b[E]=E;return b}var[Kt,O]=["material","part"],Jt={texcoord:"uv",color:"color",normal:"normal"};function ot(m,b,E,C){let D=[O,Kt].map(we=>E.find(ct=>ct.name===we&&ct.domain==="face"&&ct.components===1)),[k,B]=D.map(we=>ct=>we?.values[ct]??0);D.some(Boolean)&&b.sort((we,ct)=>k(we)-k(ct)||B(we)-B(ct)||we-ct);let q=[],ae;b.forEach((we,ct)=>{ae?.part===k(we)&&ae.material===B(we)?ae.count+=3:q.push(ae={part:k(we),material:B(we),start:3*ct,count:3})});let te=E.filter(we=>!D.includes(we)),{index:ue,vertices:Se,rows:qe}=ye(m,b,te,C),it=te.find(({semantic:we,domain:ct})=>we==="normal"&&ct!=="face"),Ye=new Map([["position",1],["normal",1]]),mt=te.flatMap((we,ct)=>{if(we===it)return[];let Gt=we.semantic==="generic"?we.name:Jt[we.semantic],An=Ye.get(Gt)??0;return Ye.set(Gt,An+1),[{name:An?`${Gt}${An}`:Gt,source:we.name,components:we.components,values:_t(we,qe[ct])}]});return{index:ue,vertices:Se,pieces:q,attributes:mt,own:it&&_t(it,qe[te.indexOf(it)])}}function lt({domain:m,values:b,components:E,indices:C},D,k){let B=new Int32Array(3*k.length),q=new Map;return k.forEach((ae,te)=>{let ue=ae;if(m==="face"){let Se=b.subarray(E*ae,E*(ae+1)).join();ue=q.get(Se)??ae,q.set(Se,ue)}for(let Se=0;Se<3;Se++){let qe=3*ae+Se;B[3*te+Se]=m==="face"?ue:m==="corner"?C?.[qe]??0:D[qe]}}),B}function ye(m,b,E,C){let D=new Uint32Array(3*b.length),k=E.filter(({domain:Ye})=>Ye!=="vertex");if(k.length===0)return b.forEach((Ye,mt)=>{for(let we=0;we<3;we++)D[3*mt+we]=m[3*Ye+we]}),{index:D,rows:E.map(()=>{})};let B=k.map(Ye=>lt(Ye,m,b)),[q,ae]=[new Int32Array(C).fill(-1),new Int32Array(D.length)],[te,ue]=[new Int32Array(D.length),new Int32Array(D.length)],Se=0;for(let Ye=0;Ye<D.length;Ye++){let mt=m[3*b[Math.floor(Ye/3)]+Ye%3],we=q[mt];for(;we>=0&&!B.every(ct=>ct[ue[we]]===ct[Ye]);)we=ae[we];we<0&&(we=Se++,[ae[we],q[mt],te[we],ue[we]]=[q[mt],we,mt,Ye]),D[Ye]=we}let qe=te.slice(0,Se),it=E.map(Ye=>{let mt=B[k.indexOf(Ye)];return mt?ue.subarray(0,Se).map(we=>mt[we]):qe});return{index:D,vertices:qe,rows:it}}function _t({semantic:m,kind:b,components:E,values:C},D){let k=m==="color"?{uint8:255,uint16:65535}[b]??1:1,B=pt(C,E,D);if(k>1)for(let q=0;q<B.length;q++)B[q]/=k;return B}var Le=30,Fe=32767,A=class{constructor(m,b,E){this.growing=m,this.e=E,this.faces=new Int32Array(0),this.points=new Float32Array(0),this.normals=new Float32Array(0),this.origin=new Int32Array(0),this.refined=new Uint8Array(0),this.waiting=new Uint8Array(0),this.u={starts:new Int32Array(1),members:new Int32Array(0)},this.o=[],this.a=new Uint8Array(0),this.c=[],this.blocks=0,this.shown=0,this.carried=[],this.r=0,this.run=0,this.limits={...d,...b}}accept(m){switch(m.type){case"header":return m.header.run>0?this.D(m.header.run):this.e(m);case"connectivity":return this.begin(m);case"block":case"refinement":return this.grow(m);case"attribute":return this.carried.push(m),this.run>0?void 0:this.e({type:"attribute",name:m.name,semantic:m.semantic,domain:m.domain});case"frame":return this.M(m);case"loss":return this.flush(),this.e(m);case"end":return this.flush(),m.positions&&this.take(m.positions),this.shape||this.finish(),this.e({...m,positions:void 0});default:return this.e(m)}}D(m){this.flush(),[this.run,this.growing]=[m,!1],this.faces=new Int32Array(0),[this.points,this.normals,this.origin]=[new Float32Array(0),new Float32Array(0),new Int32Array(0)],[this.carried.length,this.shape]=[0,void 0]}flush(){if(!this.growing||this.o.length+this.c.length===0)return;let m=Int32Array.from(this.o);this.o=[];let[b,E]=[new Float32Array(3*m.length),new Float32Array(3*m.length)],[C,D]=[new Int32Array(m.length),new Uint8Array(m.length)];m.forEach((B,q)=>{this.a[B]=0,this.T(B);for(let ae=0;ae<3;ae++)b[3*q+ae]=this.points[3*B+ae],E[3*q+ae]=this.normals[3*B+ae];C[q]=this.origin[B],D[q]=this.refined[B]});let k=this.A(this.c);this.c=[],this.shown=performance.now(),this.e({type:"grown",vertices:m,positions:b,normals:E,origin:C,refined:D,index:k,blocks:this.blocks},[m,b,E,C,D,k].map(({buffer:B})=>B))}begin({faces:m,vertices:b,loose:E}){this.faces=m,this.origin=new Int32Array(b).fill(-1),this.points=new Float32Array(3*b),this.normals=new Float32Array(3*b),E.vertices.forEach((C,D)=>this.points.set(E.positions.subarray(3*D,3*D+3),3*C)),this.growing&&(this.e({type:"begun",vertices:b,corners:m.length,loose:E}),this.refined=new Uint8Array(b),this.a=new Uint8Array(b),this.waiting=new Uint8Array(m.length/3).fill(3),this.u=$t(m,b))}E(m){this.a[m]||(this.a[m]=1,this.o.push(m))}grow(m){let{vertices:b,positions:E}=m,{points:C,origin:D,growing:k}=this;for(let B=0;B<b.length;B++){let q=b[B];for(let ae=0;ae<3;ae++)C[3*q+ae]=E[3*B+ae];k?this.B(q):D[q]=this.blocks}if(m.type==="block")this.blocks++;else if(k)for(let B of b)this.refined[B]=1;k&&performance.now()-this.shown>Le&&this.flush()}B(m){let{faces:b,waiting:E,origin:C}=this,{starts:D,members:k}=this.u,B=C[m]<0;B&&(C[m]=this.blocks),this.E(m);for(let q=D[m];q<D[m+1];q++){let ae=Math.floor(k[q]/3);B&&--E[ae]===0&&this.c.push(ae);for(let te=3*ae;te<3*ae+3;te++)this.E(b[te])}}T(m){let{faces:b,waiting:E,normals:C,points:D}=this,{starts:k,members:B}=this.u,[q,ae,te]=[0,0,0];for(let Se=k[m];Se<k[m+1];Se++){let qe=Math.floor(B[Se]/3);if(E[qe]>0)continue;let it=3*b[3*qe],Ye=3*b[3*qe+1],mt=3*b[3*qe+2],[we,ct,Gt]=[D[Ye]-D[it],D[Ye+1]-D[it+1],D[Ye+2]-D[it+2]],[An,Os,Bs]=[D[mt]-D[it],D[mt+1]-D[it+1],D[mt+2]-D[it+2]];q+=ct*Bs-Gt*Os,ae+=Gt*An-we*Bs,te+=we*Os-ct*An}let ue=Math.sqrt(q*q+ae*ae+te*te)||1;C[3*m]=q/ue,C[3*m+1]=ae/ue,C[3*m+2]=te/ue}A(m){let b=new Uint32Array(3*m.length);for(let E=0;E<b.length;E++)b[E]=this.faces[3*m[Math.floor(E/3)]+E%3];return b}take(m){this.points=new Float32Array(m),this.origin.fill(0)}M({index:m,positions:b,attributes:E}){this.r+=18*(b.length/3)+E.reduce((ue,{values:Se})=>ue+4*Se.length,0),u(this.limits,"keptBytes",this.r),this.shape||(this.take(b),this.finish());let{vertices:C,attributes:D}=un(this.shape),k=pt(b,3,C),B=pt(v(this.faces,this.origin,b),3,C),q=new Int16Array(B.length);for(let ue=0;ue<q.length;ue++)q[ue]=Math.round(B[ue]*Fe);let ae=E.flatMap(ue=>{let Se=D.find(({source:qe})=>qe===ue.name);return Se?[{...Se,values:_t(ue,C)}]:[]}),te=[k,q,...ae.map(({values:ue})=>ue)].map(({buffer:ue})=>ue);this.e({type:"frame",index:m,positions:k,normals:q,attributes:ae},te)}finish(){this.flush(),this.growing=!1;let{faces:m,origin:b,points:E,carried:C}=this,D=we=>b[m[we]]>=0,k=Zt(m.length/3),B=b.includes(-1)?k.filter(we=>D(3*we)&&D(3*we+1)&&D(3*we+2)):k,{index:q,vertices:ae,pieces:te,attributes:ue,own:Se}=C.length>0?ot(m,B,C,E.length/3):this.L(B),qe=pt(E,3,ae),it=Se??pt(v(m,b,E),3,ae),Ye=this.shape={index:q,positions:qe,normals:it,attributes:ue,vertices:ae,pieces:te,...G(qe)},mt=[q,qe,it,...ue.map(({values:we})=>we)].map(({buffer:we})=>we);this.run>0&&(this.r+=mt.reduce((we,{byteLength:ct})=>we+ct,0)),this.e({type:"whole",shape:Ye,run:this.run},mt)}L(m){let b=3*m.length===this.faces.length?new Uint32Array(this.faces):this.A(m);return{index:b,pieces:b.length>0?[{part:0,material:0,start:0,count:b.length}]:[],attributes:[]}}};function v(m,b,E){let C=new Float32Array(E.length);for(let D=0;D<m.length;D+=3){if(b[m[D]]<0||b[m[D+1]]<0||b[m[D+2]]<0)continue;let k=3*m[D],B=3*m[D+1],q=3*m[D+2],ae=E[B]-E[k],te=E[B+1]-E[k+1],ue=E[B+2]-E[k+2],Se=E[q]-E[k],qe=E[q+1]-E[k+1],it=E[q+2]-E[k+2],Ye=te*it-ue*qe,mt=ue*Se-ae*it,we=ae*qe-te*Se;C[k]+=Ye,C[k+1]+=mt,C[k+2]+=we,C[B]+=Ye,C[B+1]+=mt,C[B+2]+=we,C[q]+=Ye,C[q+1]+=mt,C[q+2]+=we}for(let D=0;D<C.length;D+=3){let k=Math.sqrt(C[D]*C[D]+C[D+1]*C[D+1]+C[D+2]*C[D+2])||1;C[D]/=k,C[D+1]/=k,C[D+2]/=k}return C}function G(m){let[b,E]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let q=0;q<m.length;q+=3)for(let ae=0;ae<3;ae++)m[q+ae]<b[ae]&&(b[ae]=m[q+ae]),m[q+ae]>E[ae]&&(E[ae]=m[q+ae]);let[C,D,k]=b.map((q,ae)=>(q+E[ae])/2),B=0;for(let q=0;q<m.length;q+=3)B=Math.max(B,(m[q]-C)**2+(m[q+1]-D)**2+(m[q+2]-k)**2);return{center:[C,D,k],radius:Math.sqrt(B),low:b,high:E}}function ce(m,b,E,C=new f(b.kernels)){let D=!1,k,B=()=>{D||k?.close(),D=!0},q=te=>{if(!D)try{te()}catch(ue){B(),E(ue instanceof e?{problem:ue.described}:{fault:`${ue}`})}},ae=(te,ue)=>{D||(("over"in te||"through"in te)&&B(),E(te,ue))};return q(()=>k=m(b,C,ae,q)),{take:te=>q(()=>k?.take(te)),stop:B}}function re(m,b,E={}){let C=new Map;m.onmessage=({data:D})=>{if("help"in D)return re(D.help,b,E);let{task:k}=D;"start"in D?(E.kernels??=new f(D.start.kernels),C.set(k,ce(b,D.start,(B,q=[])=>m.postMessage({task:k,...B},q),E.kernels))):"stop"in D?(C.get(k)?.stop(),C.delete(k)):C.get(k)?.take(D.data)}}function de(m){let b=self;re(b,m),b.postMessage({ready:!0},[])}var pe=class{constructor(m,b,E){this.decoder=m,this.start=b,this.k=E,this.taken=0;let{drawing:C,limits:D,reported:k=0}=b;this.reported=-k,C&&(this.drawing=new A(C==="growing",D,(B,q)=>this.say({picture:B},q)))}take(m){m?this.decoder.receiveData(m):this.decoder.receiveEof(),this.taken+=m?.length??0}close(){this.decoder.release()}report(){try{return this.l()}catch(m){throw this.drawing?.flush(),this.k({reported:this.reported}),m}}l(){for(;;){let m=this.decoder.nextEvent();if(typeof m=="string")return this.drawing?.flush(),m===Pe&&this.say({taken:this.taken}),m===_e&&this.say({over:!0}),m;if(this.drawing)this.drawing.accept(m);else if(m.type==="frame"){let b=Float32Array.from(m.positions);this.say({event:{...m,positions:b}},[b.buffer])}else this.say({event:m});this.reported<0&&this.drawing?.flush(),(m.type!=="block"||this.start.drawing!=="whole")&&this.reported++}}say(m,b){this.reported>=0&&this.k(m,b)}},j=class{constructor(m,b,E,C){this.start=m,this.guarded=C,this.pieces=[];let{limits:D,tolerant:k,drawing:B}=m,q=B==="whole"&&!k;this.decoder=new dt(b,D,{tolerant:k,whole:q,helpers:ae=>this.F(ae)}),this.h=new pe(this.decoder,m,E)}take(m){this.pieces?.push(m),this.l(m),this.h.take(m),this.report()}close(){this.n?.close(),this.h.close()}F(m){let{helpers:b,worthwhile:E}=this.start,C=this.pieces??[],D=Math.min(b?.length??0,Lt(m,E));if(this.pieces=void 0,D===0||!b)return 0;this.n=new at(b);let k=Se=>this.guarded(()=>{this.decoder.receiveBlock(Se),this.report()}),B=Se=>this.guarded(()=>{this.over=Se,this.report()}),{kernels:q,limits:ae,tolerant:te}=this.start,ue=this.n.begin({kernels:q,limits:ae,tolerant:te},D,{onBlock:k,onOver:B});for(let Se of C)this.l(Se);return ue}l(m){m?this.n?.receiveData(m):this.n?.receiveEof()}report(){if(this.h.report()===Ue&&this.over!==void 0)throw new Error(`a block does not come: ${this.over}`)}},ee=class{constructor({limits:m,tolerant:b},E,C,D){this.say=D,this.m=new nt(E,C,m,b)}take(m){let{m:b}=this;m?b.receiveData(m):b.receiveEof();for(let E;(E=b.nextBlock())!==Pe;){if(E===_e)return this.say({through:!0});let{block:C}=E;this.say({shared:E},C&&[C.vertices.buffer,C.positions.buffer,C.weights.buffer])}}close(){this.m.release()}};function fe(m,b,E,C){return m.share?new ee(m,b,m.share,E):new j(m,b,E,C)}function L(m,b){return ce(fe,m,b)}function ie(){de(fe)}return{BsmError:e,CorruptError:s,DEFAULT_LIMITS:d,Decoder:dt,END_OF_STREAM:_e,FormatError:t,Helper:nt,Kernels:f,LimitError:a,NEED_BLOCK:Ue,NEED_DATA:Pe,NumericError:o,Team:at,TruncatedError:r,UnsupportedError:n,checkLimit:u,decode:je,errorLike:c,hasVectors:M,openDesk:L,serve:ie}},Fr=nh,{BsmError:Tn,CorruptError:Ie,DEFAULT_LIMITS:Nf,Decoder:Uf,END_OF_STREAM:Ff,FormatError:Or,Helper:sh,Kernels:Of,LimitError:Ei,NEED_BLOCK:rh,NEED_DATA:Bf,NumericError:Br,Team:ah,TruncatedError:Ai,UnsupportedError:dn,checkLimit:oh,decode:kf,errorLike:qi,hasVectors:zf,openDesk:rl,serve:Vf}=nh()});var Vn,ch,al,hh,kr,uh,dh,Yi=et(()=>{Vn=[137,66,83,77,16],ch=128,al=5,hh={0:"values",1:"header",2:"metadata",3:"connectivity",4:"partition",5:"order",6:"block",7:"gop",12:"grid",13:"refinement",14:"attribute",15:"end"},kr={vertices:{key:1,type:"int",low:1,high:2147483647},faces:{key:2,type:"int",low:1,high:2147483647},blocks:{key:3,type:"int",low:0,high:2147483647,default:0},blockSize:{key:4,type:"int",low:0,high:2147483647,default:0},coefficients:{key:5,type:"int",low:0,high:2147483647,default:0},keyInterval:{key:6,type:"int",low:0,high:2147483647,default:0},step:{key:7,type:"float",low:9094947017729282e-28,high:1048576,default:.00390625},center:{key:8,type:"floats",low:-1e300,high:1e300,default:[0,0,0],lengths:[3,3]},scale:{key:9,type:"float",low:1e-300,high:1e300,default:1},smoothing:{key:10,type:"float",low:0,high:1e6,default:0},refinement:{key:11,type:"floats",low:0,high:64,default:[],lengths:[0,2]},attributes:{key:12,type:"int",low:0,high:255,default:0},grid:{key:13,type:"ints",low:0,high:1048575,default:[],lengths:[0,3]},lattice:{key:14,type:"ints",low:1,high:2147483647,default:[],lengths:[0,2]},corner:{key:15,type:"ints",low:-2147483648,high:2147483647,default:[],lengths:[0,3]},light:{key:16,type:"method",low:0,high:2,default:0},sequence:{key:17,type:"ints",low:0,high:2147483647,default:[],lengths:[0,2]},run:{key:18,type:"ints",low:0,high:2147483647,default:[],lengths:[0,2]},paper:{key:19,type:"floats",low:0,high:1073741824,default:[],lengths:[0,8]}},uh={bits:{key:0,type:"int",low:0,high:32,default:0},coarser:{key:1,type:"int",low:0,high:30,default:0},exact:{key:2,type:"int",low:0,high:1,default:0},power:{key:3,type:"int",low:1,high:64,default:3},iterations:{key:4,type:"int",low:1,high:1024,default:1},keyIterations:{key:5,type:"int",low:1,high:1024,default:2},shift:{key:6,type:"float",low:9313225746154785e-25,high:1073741824,default:.0078125},springs:{key:7,type:"int",low:0,high:1,default:1}},dh={vertices:16777216,faces:33554432,blocks:131072,blockSize:8192,coefficients:4096,frames:1048576,gopFrames:1024,frameBytes:268435456,metadataBytes:8388608,attributes:255,attributeValues:268435456,sequenceBytes:2147483648,work:8e8,workPerVertex:32e3,workPerByte:16e3,memoryPerByte:64,blockMemory:67108864,blockMemoryPerVertex:1024}});function $i(i){let e=new ol(i),t=[];for(let n=e.mapSize();n>0;n--){let s=e.key(),r=t.at(-1)?.[0];if(r&&Gf(r,s)>=0)throw new Ie("the keys of a map must ascend");t.push([s,e.value(!0)])}return e.finish(),t}function Gf(i,e){if(i.type==="int"&&e.type==="int")return i.value<e.value?-1:i.value>e.value?1:0;if(i.type==="int"||e.type==="int")throw new Ie("the keys of a map must be all of one type");let t=i.bytes,n=e.bytes;for(let s=0;s<Math.min(t.length,n.length);s++)if(t[s]!==n[s])return t[s]-n[s];return t.length-n.length}var zr,Hf,ol,Vr=et(()=>{xt();zr=256;Hf=[["int",204,128],["string",217,32],["binary",196,0]],ol=class{constructor(e){this.data=e;this.at=0;this.left=zr;this.view=new DataView(e.buffer,e.byteOffset,e.byteLength)}mapSize(){let e=this.byte();if(e>=128&&e<=143)return e&15;if(e!==222)throw new Ie("expected a msgpack map in its shortest form");return this.atMost(this.shortest(this.unsigned(2),16))}key(){let e=this.value(!1);if(e.type==="string"||e.type==="int"&&e.value>=0)return e;throw new Ie("the keys of a map must be unsigned integers or strings")}finish(){if(this.at!==this.data.length)throw new Ie("bytes behind a map")}value(e){let t=this.byte();if(t<128||t>=224)return{type:"int",value:t<<24>>24};if(t>=160&&t<=191)return this.text(t&31);if(e&&t>=144&&t<=159)return this.array(t&15);if(e&&t===220)return this.array(this.shortest(this.unsigned(2),16));for(let[n,s,r]of Hf){if(t<s||t>s+2)continue;let a=t-s,o=this.shortest(this.unsigned(1<<a),[r,256,65536][a]);return n==="int"?{type:n,value:o}:n==="string"?this.text(o):{type:n,value:this.bytes(o)}}switch(t){case 207:return this.large(this.view.getBigUint64(this.take(8)),n=>n>=1n<<32n);case 208:return this.negative(this.view.getInt8(this.take(1)),-32);case 209:return this.negative(this.view.getInt16(this.take(2)),-128);case 210:return this.negative(this.view.getInt32(this.take(4)),-32768);case 211:return this.large(this.view.getBigInt64(this.take(8)),n=>n<-(1n<<31n));case 202:return{type:"float",value:this.finite(this.view.getFloat32(this.take(4)))};case 203:return this.double()}throw new Ie(`a map may not hold a value that begins with byte ${t} here`)}array(e){if(this.left-=e,this.left<0)throw new Ie(`the arrays of a map have more than ${zr} entries`);return{type:"array",value:Array.from({length:this.atMost(e)},()=>this.value(!1))}}text(e){let t=this.bytes(e);try{return{type:"string",value:new TextDecoder("utf-8",{fatal:!0,ignoreBOM:!0}).decode(t),bytes:t}}catch{throw new Ie("a string of a map is not UTF-8")}}double(){let e=this.finite(this.view.getFloat64(this.take(8)));if(Math.fround(e)===e)throw new Ie("a number of a map is not in its shortest form");return{type:"float",value:e}}large(e,t){if(!t(e))throw new Ie("an integer of a map is not in its shortest form");return{type:"int",value:e}}negative(e,t){if(e>=t)throw new Ie("an integer of a map is not in its shortest form");return{type:"int",value:e}}shortest(e,t){if(e<t)throw new Ie("a map is not in its shortest form");return e}atMost(e){if(e>zr)throw new Ie(`more than ${zr} entries in a map or an array`);return e}finite(e){if(!Number.isFinite(e))throw new Ie("a map may not hold a number that is not finite");return e}byte(){return this.data[this.take(1)]}bytes(e){let t=this.take(e);return this.data.slice(t,t+e)}unsigned(e){return this.bytes(e).reduce((t,n)=>256*t+n,0)}take(e){if(e>this.data.length-this.at)throw new Ie("a map ends too early");return this.at+=e,this.at-e}}});function Zi(i,e,t){let n=0;for(let s=0;s<al&&e+s<t;s++){let r=i[e+s];if(n+=(r&127)*2**(7*s),r<128){if(r===0&&s>0)throw new Ie("a varint is not in its shortest form");return{value:n,end:e+s+1}}}if(!(t-e<al))throw new Ie("a varint is longer than five bytes")}var Gr=et(()=>{Yi();xt()});function ph(){return globalThis.navigator?.hardwareConcurrency??1}function Gn(){let i=[0,97,115,109,1,0,0,0,1,5,1,96,0,1,123,3,2,1,0,10,8,1,6,0,65,0,253,15,11];return WebAssembly.validate(Uint8Array.from(i))}var zs=et(()=>{});function jt(i,e,t){if(t>i[e])throw new Ei(`${e} = ${t} is over the limit of ${i[e]}; raise it if you trust the source`)}function mh(i,e,t,n){let s=i.blockMemory+i.blockMemoryPerVertex*t+i.memoryPerByte*n;jt({...i,blockMemory:s},"blockMemory",e)}var Ki,Hn=et(()=>{Yi();xt();Ki={...dh,keptBytes:2**30,memory:2**31}});var Ti,ll=et(()=>{Ti=class i{constructor(e){this.module=e}static async compile(e){return new i(await WebAssembly.compile(e))}borrow(){let e=this.waiting??new WebAssembly.Instance(this.module).exports;return this.waiting=void 0,e}take(e){e.memory.buffer.byteLength<=16777216&&(this.waiting=e)}}});function Nt(i){if(i===void 0)throw new RangeError("a stage of the decoder is asked for what it has not begun");return i}var Hr=et(()=>{});function Ji(i,e=0){let t=~e;for(let n=0;n<i.length;n++)t=Wf[(t^i[n])&255]^t>>>8;return~t>>>0}function gh(i){let e=0;for(let t=0;t<i.length;t++)e=e<<8&65535^Xf[e>>8^i[t]];return e}var Wf,Xf,cl=et(()=>{Wf=Uint32Array.from({length:256},(i,e)=>{let t=e;for(let n=0;n<8;n++)t=t&1?t>>>1^3988292384:t>>>1;return t}),Xf=Uint16Array.from({length:256},(i,e)=>{let t=e<<8;for(let n=0;n<8;n++)t=t&32768?t<<1^4129:t<<1;return t})});var Wr,_h=et(()=>{Hn();Wr=class{constructor(e){this.limits=e;this.owed=0;this.vertices=0}grant(e){this.vertices+=e}charge(e,t=0){let{limits:n,vertices:s}=this;this.owed+=Math.max(0,e-n.workPerByte*t),jt({...n,work:n.work+n.workPerVertex*s},"work",this.owed)}}});function ul(i){return i+qf+2}function Ri(i,e){let{slots:t,selectors:n,inputs:s,limit:r=255,rate:a=14,probability:o=hl/2,trust:l=0}=e,c=[i.words(t),i.ints(n*s,s),i.longs(2)],h=s<3?Math.floor(hl/s):Math.floor(hl*5/(4*s));return c[0].view.fill((o<<16|l)>>>0),c[1].view.fill(h),c[2].view.set([BigInt(r),BigInt(a)]),c}var hl,qf,yh,Yf,ri,Xr=et(()=>{xt();hl=65536,qf=24,yh=2**32-1,Yf=2;ri=class{constructor(e,t){let n=[0,1,2,3].reduce((s,r)=>s*256+(t[r]??0),0);if(n>=yh)throw new Ie("an entropy-coded payload cannot begin with ff ff ff ff");this.parts=[e.longs(5),e.bytes(t.length)],this.parts[0].view.set([BigInt(n),BigInt(yh),4n,1n,0n]),this.parts[1].view.set(t)}get overran(){return this.position>this.size+4}finish(){if(this.overran)throw new Ai(`an entropy-coded payload of ${this.size} bytes ends too early`);if(this.position<this.size)throw new Ie("bytes are left over behind the last symbol of a payload")}nonsense(e){return this.overran?new Ai(`an entropy-coded payload of ${this.size} bytes ends too early`):new Ie(`a payload is damaged: ${e}`)}get position(){return Number(this.parts[0].view[Yf])}get size(){return this.parts[1].length}}});function np(i,e){let t=Math.min(Math.max(32-Math.clz32(e)-2,6),12),{contexts:n,nodes:s}=$f;return[Ri(i,{slots:(n<<t)*s,selectors:s,inputs:n,limit:1023,rate:16}),Ri(i,{slots:dl.contexts*dl.size,selectors:1,inputs:dl.contexts,limit:1023,rate:16,probability:vh-Math.floor(vh/500),trust:30}),Ri(i,{slots:xh*fl,selectors:xh*fl,inputs:1}),BigInt(t)]}function Sh(i,e,t,n){let s=i.ints(3*t.faces,3);return i.scratch(()=>{let r=new ri(i,e),a=np(i,t.vertices),[o,l,c,h]=[0,1,2,3].map(()=>ip(i,r,a)),d=t.faces-o,u=t.vertices-l,f=u+c;if(d<0||u<0||l>3*o||f>3*d||h>3*d)throw r.nonsense("the counts at its start contradict each other");jt(n,"vertices",f+h),mh(n,Qf*t.faces+ep*t.vertices+tp*(c+h),t.vertices,e.length);let _=s.part(0,3*d,3);sp(i,r,a,_,f,h);let M=c>0?rp(i,r,_,f):f,p=s.part(_.length,s.length-_.length);if(M!==u||i.call("code_degenerate",r.parts,p,BigInt(M))!==t.vertices)throw r.nonsense(`it does not make ${t.vertices} vertices`);r.finish()}),s}function ip(i,e,t){return i.scratch(()=>{let n=i.longs(1);return n.view[0]=0n,i.call("code_one_unsigned",e.parts,t[2],n,0n,BigInt(Mh),0n,BigInt(Zf))})}function sp(i,e,t,n,s,r){let a=i.ints(ji.heads);a.view.fill(-1),a.view[ji.made]=a.view[ji.alive]=0;let o=i.longs(qr.size);o.view.fill(0n),o.view[qr.dummies]=BigInt(r),o.view[qr.turns]=BigInt(4*n.rows),o.view[qr.steps]=BigInt(65536+16*n.rows);let l=i.longs(2*(s+r),2),c=i.ints(0),h=[[c,c,c,c],i.bytes(0),c,c,c,c],d=i.ints(ji.columns*(s+16),ji.columns);for(;;){let u=i.call("conquer",e.parts,t,h,[[d,a],l,n,o]);if(u===Kf)throw e.nonsense(`it does not make ${n.rows} triangles`);if(u!==Jf)return;let f=d;d=i.ints(2*f.length,ji.columns),d.view.set(f.view)}}function rp(i,e,t,n){let s=i.ints(n),r=i.ints(n);s.view.fill(-1),r.view.fill(-1),i.scratch(()=>ap(i,t,s,r));let a=i.ints(n);a.view.fill(-1);let o=i.ints(n),l=[o,s,r,i.ints(n),i.ints(n)],c=i.call("code_fans",e.parts,Ri(i,{slots:32,selectors:1,inputs:1}),a,l);if(c>=0){let h=o.view,d=t.view;for(let u=0;u<d.length;u++)d[u]=h[d[u]]}return c}function ap(i,e,t,n){let s=e.length,r=e.part(0,s),a=i.longs(t.length+1),o=i.ints(s);i.run("match_halfedges",r,a,i.ints(s),i.ints(s),o);let[l,c,h,d]=[r.view,o.view,t.view,n.view];for(let u=0;u<s;u++)c[u]<0&&(h[l[u]]=l[u%3===2?u-2:u+1]);for(let u=0;u<h.length;u++)h[u]>=0&&(d[h[u]]=u)}function wh(i,e,t,n){let s=t.length/3,r=bh(i,e,n),a=bh(i,e,s),o=op(i,e,s),l=t.view.map(d=>r[d]),c=new Int32Array(l.length),h=new Int32Array(l.length);return lp(l).forEach((d,u)=>{let f=a[u],_=l.subarray(3*d,3*d+3),M=0;for(let p=1;p<3;p++)_[p]<_[M]&&(M=p);M+=o[f];for(let p=0;p<3;p++)h[3*f+p]=3*d+(M+p)%3,c[3*f+p]=_[(M+p)%3]}),{numbers:r,faces:c,corners:h}}function op(i,e,t){return i.scratch(()=>{let n=i.ints(t);n.view.fill(0);let s=Ri(i,{slots:108,selectors:2,inputs:2});return Eh(e,i.call("code_turns",e.parts,s,n),`${t} rotations`),n.view.slice()})}function bh(i,e,t){return i.scratch(()=>{let{unary:n,inputs:s,classes:r}=jf,a=ul(n)+3,o=Ri(i,{slots:(1+r+2*r*r)*a,selectors:a,inputs:s}),l=i.ints(t);return l.view.fill(0),Eh(e,i.call("code_steps",e.parts,o,l,i.ints(t+1)),`an order of ${t}`),l.view.slice()})}function Eh(i,e,t){if(i.overran||!e)throw i.nonsense(`it is not ${t}`)}function lp(i){let e=i.slice();for(let t=0;t<e.length;t+=3)e.subarray(t,t+3).sort();return Uint32Array.from({length:i.length/3},(t,n)=>n).sort((t,n)=>{for(let s=2;s>=0;s--){let r=e[3*t+s]-e[3*n+s];if(r!==0)return r}return t-n})}var vh,$f,dl,Mh,xh,fl,Zf,ji,qr,Kf,Jf,jf,Qf,ep,tp,pl=et(()=>{Xr();Hn();vh=65536,$f={contexts:14,nodes:16},dl={contexts:3,size:4096},Mh=2,xh=6,fl=ul(Mh),Zf=5*fl,ji={columns:8,buckets:8,heads:18,made:8,alive:9},qr={size:8,dummies:3,turns:4,steps:5},[Kf,Jf]=[1,2],jf={unary:6,inputs:4,classes:32},[Qf,ep,tp]=[100,400,240]});function Yr(i){let e=new Int32Array(i);for(let t=0;t<i;t++)e[t]=t;return e}var ml=et(()=>{});function hp(i,e){let t=i.ints(e);return t.view.set(Yr(e)),t}function up(i,e,t,n){let s=i.ints(t+1),r=i.ints(e.length),a=i.ints(e.length),o=[e,s,r,a,n];return i.scratch(()=>i.call("link_corners",o,i.ints(t+e.length))),o}function Ah(i){return i.view.fill(0),i}function dp(i,e,t,n,s,r){i.scratch(()=>{let a=new ri(i,n),o=i.call(e,a.parts,...t,BigInt(s),BigInt(r));if(a.overran||o<r)throw a.nonsense(`vertex ${o} of ${r} has a value out of range`);a.finish()})}var cp,$r,Th=et(()=>{Xr();xt();ml();cp=3624;$r=class{constructor(e,t,n){this.memory=e;this.header=n;this.coded=0;let{vertices:s,corner:r,center:a,scale:o}=n;this.places=e.doubles(3*s,3),this.places.view.fill(0),this.frame=e.copy([...r.length>0?r:[0,0,0],...a,o]);let l=e.ints(3);l.view.set(n.grid),this.values=Ah(e.ints(3*s,3));let c=Ah(e.ints(3*s,3));this.order=hp(e,s);let h=up(e,t,s,this.order),d=e.words(cp);d.view.fill(2**31),this.state=[h,[l,this.values,c,d]]}decode(e,t,n){let{memory:s,header:r,places:a,order:o}=this;if(e!==this.coded)throw new Ie(`positions from number ${this.coded} on are missing; others depend on them`);return dp(s,"code_light",this.state,n,e,t),this.coded+=t,s.scratch(()=>{let[l,c]=r.lattice.length>0?r.lattice.map(BigInt):[0n,0n],h=o.part(e,t),d=s.doubles(3*t,3);if(!s.call("place_values",this.values,h,l,c,this.frame,d,a))throw new Br("positions are not finite in the unit of the mesh");return{vertices:h.view.slice(),positions:d.view.slice(),final:new Uint8Array(t).fill(1)}})}get positions(){return this.places.view.slice()}}});function Ph(i){return Math.ceil(i/Rh)*Rh}var Zr,fp,Rh,Ch,pp,Kr,Ih=et(()=>{xt();Zr=class i{constructor(e,t,n,s,r){this.memory=e;this.kind=t;this.pointer=n;this.length=s;this.columns=r}get view(){let{buffer:e}=this.memory,{numbers:t}=this;return t?.buffer===e?t:this.numbers=new this.kind(e,this.pointer,this.length)}get rows(){return this.columns===void 0?this.length:this.columns&&this.length/this.columns}part(e,t,n){if(e<0||t<0||e+t>this.length)throw new RangeError("a part outside of its array");return new i(this.memory,this.kind,this.pointer+e*this.kind.BYTES_PER_ELEMENT,t,n)}},fp=65536,Rh=16,Ch=1024,pp=-(2n**63n),Kr=class{constructor(e,t){this.exports=e;this.limit=t;this.buffer=e.memory.buffer,this.frame=Ph(e.__heap_base.value),this.top=this.frame+Ch,this.reserve(this.top),this.run("make_tables")}get size(){return this.top}mark(){return this.top}release(e){this.top=e}scratch(e){let t=this.mark();try{return e()}finally{this.release(t)}}bytes(e){return this.place(Uint8Array,e)}ints(e,t){return this.place(Int32Array,e,t)}words(e){return this.place(Uint32Array,e)}longs(e,t){return this.place(BigInt64Array,e,t)}doubles(e,t){return this.place(Float64Array,e,t)}copy(e,t){let n=this.doubles(e.length,t);return n.view.set(e),n}call(e,...t){let n=this.invoke(e,t);if(n===pp)throw new RangeError(`arrays that do not fit together were given to ${e}`);return Number(n)}run(e,...t){return Number(this.invoke(e,t)??0)}invoke(e,t){let n=new DataView(this.buffer,this.frame,Ch),s=0,r=l=>{if(typeof l=="bigint")n.setBigInt64(s,l,!0);else if(typeof l=="number")n.setFloat64(s,l,!0);else return l instanceof Zr?a(l):l.forEach(r);s+=8},a=({pointer:l,rows:c,columns:h})=>{n.setUint32(s,l,!0);for(let d of h===void 0?[c]:[c,h])n.setBigInt64(s+=8,BigInt(d),!0);s+=8},o=t.map(l=>{if(typeof l=="bigint"||typeof l=="number")return l;let c=s;return r(l),this.frame+c});return this.exports[e](...o)}place(e,t,n){let s=this.top,r=Ph(s+t*e.BYTES_PER_ELEMENT);return this.reserve(r),this.top=r,new Zr(this,e,s,t,n)}reserve(e){if(e>this.limit)throw new Ei(`memory = ${e} bytes is over the limit of ${this.limit}`);let t=this.buffer.byteLength;if(!(e<=t))try{this.exports.memory.grow(Math.ceil(Math.max(e-t,Math.min(t/4,this.limit-t))/fp)),this.buffer=this.exports.memory.buffer}catch{throw new Ei(`this machine has no ${e} bytes of memory for the decoder`)}}}});function Vs(i,e){let t=new Int32Array(e+1);for(let r of i)r>=0&&t[r+1]++;for(let r=0;r<e;r++)t[r+1]+=t[r];let n=new Int32Array(t[e]),s=t.slice();return i.forEach((r,a)=>r>=0&&(n[s[r]++]=a)),{starts:t,members:n}}var Qi,Jr=et(()=>{Qi=class{constructor(e,t,n,s={vertices:new Int32Array(0),positions:new Float64Array(0)}){this.faces=e;this.coded=t;this.source=n;this.loose=s;n&&(this.copies=Vs(n,t))}get size(){return this.source?.length??this.coded}spread(e){if(!this.copies)return e;let{starts:t,members:n}=this.copies,[s,r]=[[],[]];e.vertices.forEach((o,l)=>{for(let c=t[o];c<t[o+1];c++)s.push(n[c]),r.push(l)});let a=Float64Array.from({length:3*r.length},(o,l)=>e.positions[3*r[Math.floor(l/3)]+l%3]);return{vertices:Int32Array.from(s),positions:a,final:Uint8Array.from(r,o=>e.final[o])}}arranged(e){let{source:t}=this;if(!t)return e;let n=new Float64Array(3*t.length);for(let s=0;s<t.length;s++){let[r,a]=[3*s,3*t[s]];for(let o=0;a>=0&&o<3;o++)n[r+o]=e[a+o]}return this.loose.vertices.forEach((s,r)=>n.set(this.loose.positions.subarray(3*r,3*r+3),3*s)),n}}});function Lh(i,e,t){let n=new Map(Object.entries(e).map(([a,o])=>[o.key,a])),s={},r=$i(i);for(let[a,o]of r)gp(a,o,n,e,t);for(let[a,o]of r){let l=n.get(Number(a.value)),c=_p(l,e[l],o,t);if(jr(c,e[l].default))throw new Ie(`${t} field ${l} is stored with its default value`);s[l]=c}for(let[a,o]of Object.entries(e)){s[a]??=o.default;let l=s[a];if(l===void 0)throw new Ie(`the ${t} lacks ${a}`);yp(a,o,l,t)}return s}function gp(i,e,t,n,s){if(i.type!=="int")throw new Ie(`a ${s} key is not an integer`);let r=t.get(Number(i.value));if(r===void 0)throw new dn(`${s} key ${i.value} is unknown to this decoder`);let{type:a,high:o}=n[r];if(a==="method"&&e.type==="int"&&e.value>o&&e.value<=mp)throw new dn(`${s} field ${r} names method ${e.value}, unknown to this decoder`)}function _p(i,{type:e},t,n){if(e==="floats"||e==="ints"){if(t.type==="array")return t.value.map(s=>{if(`${s.type}s`===e)return Number(s.value);throw new Ie(`an entry of the ${n} field ${i} is of type ${s.type}`)})}else if(e==="string"){if(t.type===e)return t.value}else if(t.type===(e==="float"?"float":"int"))return Number(t.value);throw new Ie(`${n} field ${i} is of type ${t.type}`)}function jr(i,e){return typeof i!="object"||typeof e!="object"?i===e:i.length===e.length&&i.every((t,n)=>t===e[n])}function yp(i,{low:e,high:t,lengths:n=[1,1]},s,r){let a=Array.isArray(s)?s:[s],o=a.map(l=>typeof l=="number"?l:typeof l=="string"?new TextEncoder().encode(l).length:l.length);if(a.length<n[0]||a.length>n[1]||!o.every(l=>l>=e&&l<=t))throw new Ie(`${r} field ${i} = ${s} is outside its legal range`)}var mp,Dh=et(()=>{xt();Vr();mp=255});function Uh(i,e){if(i.length>Nh)throw new Ie(`a header of ${i.length} bytes, where ${Nh} are legal`);let t=Lh(i,gl,"header"),{sequence:n,run:s,paper:r,...a}=t;if(a.grid.length===0||a.light!==Mp||a.attributes>0||n.length>0)throw new dn("this build decodes light grids alone, which this is not; small.js and bsm.js decode more");let o={...a,frames:0,gopFrames:0,run:0,again:void 0,paper:vp};ai("more vertices than the corners of its faces",o.vertices>3*o.faces),Sp(o,Object.entries(t).some(([l,c])=>!bp.includes(l)&&!jr(c,gl[l].default)));for(let l of xp)jt(e,l,o[l]);return o}function ai(i,e){if(e)throw new Ie(`the header contradicts itself: ${i}`)}function Sp({center:i,corner:e,grid:t,lattice:n},s){let[r,a]=n.length===2?n:[0,0];ai("a grid of other than three axes",t.length!==3),ai("a lattice that is not cells and points",n.length===1),ai("a lattice with fewer points than the grid has values",a>0&&a<Math.max(...t)),ai("a lattice of more points than cells",a>r),ai("a corner of other than three axes",e.length%3!==0),ai("a corner and a center",e.length>0&&!jr(i,gl.center.default)),ai("a grid, and fields of blocks",s)}var vp,gl,Nh,xp,bp,Mp,Fh=et(()=>{Yi();xt();Hn();Dh();vp=Object.fromEntries(Object.entries(uh).map(([i,e])=>[i,e.default])),gl=kr,Nh=2**16,xp=["vertices","faces","attributes"],bp=["vertices","faces","center","scale","attributes","grid","lattice","corner","light"],Mp=1});function Bh(i,e){for(let t of i.keys())if(e.has(t))throw new Ie(`metadata speak of "${t}" again`)}function kh({first:i,count:e},t,n){if(i!==t)throw new Ie(`vertices begin at ${i}, expected ${t}`);if(e===0||e>n.vertices-i)throw new Ie(`${e} vertices from ${i} on`)}function zh(i,e){if(i<e.vertices)throw new Ie(`the positions end at vertex ${i} of ${e.vertices}`)}function Qr(i){return i.reduceRight((e,t)=>e*256+t,0)}var es,Oh,ea=et(()=>{xt();Fh();Hn();Vr();Gr();es=class{constructor(e){this.payload=e;this.at=0}varint(){let e=Zi(this.payload,this.at,this.payload.length);if(!e)throw new Ie("a payload ends inside a varint");return this.at=e.end,e.value}take(e){if(e>this.payload.length-this.at)throw new Ie(`a payload lacks ${e} bytes`);return this.at+=e,this.payload.subarray(this.at-e,this.at)}rest(){return this.take(this.payload.length-this.at)}get ended(){return this.at===this.payload.length}finish(){if(this.at!==this.payload.length)throw new Ie("a payload has bytes too many")}},Oh={header:(i,e)=>({type:"header",header:Uh(i.rest(),e)}),metadata:(i,e)=>{let t=i.rest();jt(e,"metadataBytes",t.length);let n=new Map;for(let[s,r]of $i(t)){if(s.type!=="string"||r.type==="array")throw new Ie("metadata of a wrong type");n.set(s.value,r.value)}return{type:"metadata",entries:n}},connectivity:i=>({type:"connectivity",data:i.rest()}),order:i=>({type:"order",data:i.rest()}),grid:i=>({type:"grid",first:i.varint(),count:i.varint(),data:i.rest()}),end:i=>{let e=i.varint(),t=i.take(4),n=i.ended?void 0:Qr(i.take(4));return i.finish(),{type:"end",frames:e,crc:Qr(t),positions:n}}}});function Vh(i,e,t,{vertices:n}){let s=new es(e);if(s.varint()+s.varint()>0)throw new dn("this build decodes no split vertices; bsm.js does");return i.scratch(()=>{let r=new ri(i,s.rest()),{faces:a,numbers:o}=wh(i,r,t,n);return r.finish(),new Qi(a,n,Vs(o,n).members)})}var Gh=et(()=>{pl();Xr();xt();Jr();ea()});var wp,ta,Hh=et(()=>{xt();ea();wp={start:["header"],header:["connectivity"],connectivity:["order","grid","end"],order:["grid","end"],grid:["grid","end"]},ta=class{constructor(){this.last="start";this.entryNames=new Set;this.nextVertex=0}get ended(){return this.last==="end"}check(e){let{header:t,nextVertex:n}=this;if(!(e.type==="metadata"?t:wp[this.last]?.includes(e.type)))throw new Ie(`unexpected section ${e.type}`);e.type==="metadata"&&Bh(e.entries,this.entryNames),t&&(e.type==="grid"&&kh(e,n,t),e.type==="end"&&zh(n,t))}advance(e){if(e.type==="metadata"){for(let t of e.entries.keys())this.entryNames.add(t);return}e.type==="header"&&(this.header=e.header),e.type==="grid"&&(this.nextVertex=e.first+e.count),this.last=e.type}}});var Ci,ts,na=et(()=>{Ci="need data",ts="end of stream"});function Lp(i){let e=i.value%16,t=Math.floor(i.value/16),n=i.end+t;return{type:e,length:t,sum:n,end:n+(e===Pp||t<ch?2:4)}}var Ep,Ap,Tp,Rp,Wh,Cp,Pp,Ip,ia,Xh=et(()=>{Yi();cl();xt();Hh();Hn();ea();na();Gr();[Ep,Ap,Tp,Rp]=[8e3,8,2e4,8e3],Wh=4,Cp=15,Pp=6,Ip=hh;ia=class{constructor(e,t){this.limits=e;this.charge=t;this.begin=0;this.end=0;this.eof=!1;this.grammar=new ta;this.buffer=new Uint8Array(0);this.offset=0;this.frames=0;this.crc=0;this.metadataRead=0;this.started=!1}receiveData(e){if(this.eof)throw new Error("bytes were given to a reader after receiveEof");this.error||e.length===0||(this.end+e.length>this.buffer.length&&this.makeRoom(e.length),this.buffer.set(e,this.end),this.end+=e.length)}receiveEof(){this.eof=!0}get position(){return this.offset}nextPacket(){if(this.error)throw this.error;try{return this.next()}catch(e){throw e instanceof Tn&&(this.error=e.located({offset:this.offset,frame:this.started?this.frames:void 0}),this.buffer=new Uint8Array(0)),e}}makeRoom(e){let t=this.end-this.begin,n=t+e>this.buffer.length/2?new Uint8Array(2*(t+e)+1024):this.buffer;n.set(this.buffer.subarray(this.begin,this.end)),this.buffer=n,this.begin=0,this.end=t}next(){if(!this.started&&!this.start())return Ci;for(;!this.grammar.ended;){let e=this.frame();if(!e)return this.incomplete();this.charge(Ep+Ap*e.size,e.size);let t=this.parse(e.type,e.payload);if(t?.type==="metadata"&&this.charge(Tp+Rp*t.entries.size,0),t&&this.grammar.advance(t),t?.type==="metadata"&&(this.metadataRead+=e.payload.length),this.crc=Ji(this.buffer.subarray(this.begin,this.begin+e.size),this.crc),this.skip(e.size),t)return t}if(this.end>this.begin)throw new Ie("data after END");return this.eof?ts:Ci}start(){let e=this.buffer.subarray(this.begin,Math.min(this.end,this.begin+Vn.length));for(let t=0;t<e.length;t++)if(!((e[t]^Vn[t])<=(t<Wh?0:Cp)))throw t<Wh?new Or("not a BSM stream: it does not begin with 89 42 53 4D",{offset:0}):new dn(`written by version ${e[t]>>4}, and this reads ${Vn[t]>>4}; if that is later, encode the source again`,{offset:t});return e.length<Vn.length?(this.incomplete(),!1):(this.crc=Ji(e),this.drop(Vn.length),this.started=!0,!0)}incomplete(){if(!this.eof)return Ci;throw new Ai("the stream ends before its END frame; get the rest of it",{offset:this.offset+this.end-this.begin})}frame(){let e=this.begin,t=Zi(this.buffer,e,this.end);if(!t)return;let{type:n,length:s,sum:r,end:a}=Lp(t);if(jt(this.limits,"frameBytes",s),a>this.end)return;let o=this.buffer.subarray(e,r),l=a-r===2?gh(o):Ji(o);if(Qr(this.buffer.subarray(r,a))!==l)throw new Ie(`the checksum of a frame of type ${n} and ${s} bytes is wrong`);return{type:n,payload:this.buffer.slice(t.end,r),size:a-e}}parse(e,t){if(e>=8&&e<=11){if(!this.grammar.header)throw new Ie("the first frame must be HEADER");return}let n=Ip[e],s=Oh[n];if(!s)throw new dn(`frame type ${e} is unknown to this decoder`);let r=s(new es(t),this.limits);if(this.grammar.check(r),n==="metadata"&&jt(this.limits,"metadataBytes",this.metadataRead+t.length),r.type==="end"){if(r.frames!==this.frames)throw new Ie(`END counts ${r.frames} frames before it`);if(r.crc!==this.crc)throw new Ie("the CRC-32 of the whole stream is wrong")}return r}skip(e){this.frames++,this.drop(e)}drop(e){this.begin+=e,this.offset+=e}}});function qh(i,e,t){return 140*i+85*e+700*Math.max(0,e/2-i)+400*t}function Yh(i,e,t){return 500*i+750*e+100*t}var _l,$h=et(()=>{_l={whole:(i,e)=>200*i+40*e,frame:i=>5e4+120*i}});var sa,yl=et(()=>{Hr();cl();_h();pl();xt();Th();Hn();Ih();Jr();Gh();Xh();na();$h();sa=class{constructor(e,t={}){this.kernels=e;this.queue=[];this.chunks=0;this.limits={...Ki,...t},this.memory=new Kr(e.borrow(),this.limits.memory),this.budget=new Wr(this.limits),this.reader=new ia(this.limits,this.budget.charge.bind(this.budget))}receiveData(e){this.reader.receiveData(e)}receiveEof(){this.reader.receiveEof()}get position(){return this.reader.position}nextEvent(){for(;;){let e=this.queue.shift();if(e)return e;if(this.error)throw this.error;try{let t=this.reader.nextPacket();if(typeof t=="string")return t;this.accept(t)}catch(t){if(!(t instanceof Tn))throw t;this.error=t.located({offset:this.reader.position})}}}release(){this.kernels.take(this.memory.exports)}finish(){for(this.receiveEof();this.nextEvent()!==ts;);let[e,t]=[Nt(this.numbering),Nt(this.grid)];return{positions:e.arranged(t.positions),faces:e.faces,attributes:[]}}accept(e){switch(e.type){case"header":return this.acceptHeader(e.header);case"metadata":return void this.queue.push(e);case"connectivity":return this.acceptConnectivity(e.data);case"order":return this.acceptOrder(e.data);case"grid":return this.acceptGrid(e.first,e.count,e.data);case"end":this.check(e.positions),this.queue.push({type:"end",missing:new Int32Array(0),degraded:new Int32Array(0)})}}check(e){if(e===void 0)return;let t=Nt(this.grid).positions.map(n=>n+0);if(Ji(new Uint8Array(t.buffer))!==e)throw new Ie("the checksum of decoded positions is wrong: they are not those that the encoder saw")}acceptHeader(e){this.header=e,this.queue.push({type:"header",header:e})}acceptConnectivity(e){let t=Nt(this.header);this.faces=Sh(this.memory,e,t,this.limits),this.budget.grant(t.vertices),this.budget.charge(qh(t.vertices,t.faces,e.length),e.length)}acceptOrder(e){let{vertices:t,faces:n}=Nt(this.header);this.budget.charge(Yh(t,n,e.length),e.length),this.numbering=Vh(this.memory,e,Nt(this.faces),Nt(this.header))}acceptGrid(e,t,n){let s=this.grid??=this.begunGrid();this.budget.charge(_l.frame(n.length),n.length);let r=s.decode(e,t,n);this.queue.push({type:"block",index:this.chunks++,...Nt(this.numbering).spread(r)})}begunGrid(){let{vertices:e,faces:t}=Nt(this.header);this.numbering??=new Qi(Nt(this.faces).view.slice(),e);let{size:n,loose:s}=this.numbering;return this.queue.push({type:"connectivity",faces:this.numbering.faces.slice(),vertices:n,loose:s}),this.budget.charge(_l.whole(e,t)),new $r(this.memory,Nt(this.faces),Nt(this.header))}}});function Pi(i,e,t){if(!t)return new Float32Array(i);let n=new Float32Array(e*t.length);for(let s=0;s<t.length;s++)for(let r=0;r<e;r++)n[e*s+r]=i[e*t[s]+r];return n}var vl=et(()=>{});function Zh(i,e,t,n){let s=[Np,Dp].map(p=>t.find(g=>g.name===p&&g.domain==="face"&&g.components===1)),[r,a]=s.map(p=>g=>p?.values[g]??0);s.some(Boolean)&&e.sort((p,g)=>r(p)-r(g)||a(p)-a(g)||p-g);let o=[],l;e.forEach((p,g)=>{l?.part===r(p)&&l.material===a(p)?l.count+=3:o.push(l={part:r(p),material:a(p),start:3*g,count:3})});let c=t.filter(p=>!s.includes(p)),{index:h,vertices:d,rows:u}=Op(i,e,c,n),f=c.find(({semantic:p,domain:g})=>p==="normal"&&g!=="face"),_=new Map([["position",1],["normal",1]]),M=c.flatMap((p,g)=>{if(p===f)return[];let S=p.semantic==="generic"?p.name:Up[p.semantic],P=_.get(S)??0;return _.set(S,P+1),[{name:P?`${S}${P}`:S,source:p.name,components:p.components,values:ra(p,u[g])}]});return{index:h,vertices:d,pieces:o,attributes:M,own:f&&ra(f,u[c.indexOf(f)])}}function Fp({domain:i,values:e,components:t,indices:n},s,r){let a=new Int32Array(3*r.length),o=new Map;return r.forEach((l,c)=>{let h=l;if(i==="face"){let d=e.subarray(t*l,t*(l+1)).join();h=o.get(d)??l,o.set(d,h)}for(let d=0;d<3;d++){let u=3*l+d;a[3*c+d]=i==="face"?h:i==="corner"?n?.[u]??0:s[u]}}),a}function Op(i,e,t,n){let s=new Uint32Array(3*e.length),r=t.filter(({domain:_})=>_!=="vertex");if(r.length===0)return e.forEach((_,M)=>{for(let p=0;p<3;p++)s[3*M+p]=i[3*_+p]}),{index:s,rows:t.map(()=>{})};let a=r.map(_=>Fp(_,i,e)),[o,l]=[new Int32Array(n).fill(-1),new Int32Array(s.length)],[c,h]=[new Int32Array(s.length),new Int32Array(s.length)],d=0;for(let _=0;_<s.length;_++){let M=i[3*e[Math.floor(_/3)]+_%3],p=o[M];for(;p>=0&&!a.every(g=>g[h[p]]===g[_]);)p=l[p];p<0&&(p=d++,[l[p],o[M],c[p],h[p]]=[o[M],p,M,_]),s[_]=p}let u=c.slice(0,d),f=t.map(_=>{let M=a[r.indexOf(_)];return M?h.subarray(0,d).map(p=>M[p]):u});return{index:s,vertices:u,rows:f}}function ra({semantic:i,kind:e,components:t,values:n},s){let r=i==="color"?{uint8:255,uint16:65535}[e]??1:1,a=Pi(n,t,s);if(r>1)for(let o=0;o<a.length;o++)a[o]/=r;return a}var Dp,Np,Up,Kh=et(()=>{vl();[Dp,Np]=["material","part"],Up={texcoord:"uv",color:"color",normal:"normal"}});function Jh(i,e,t){let n=new Float32Array(t.length);for(let s=0;s<i.length;s+=3){if(e[i[s]]<0||e[i[s+1]]<0||e[i[s+2]]<0)continue;let r=3*i[s],a=3*i[s+1],o=3*i[s+2],l=t[a]-t[r],c=t[a+1]-t[r+1],h=t[a+2]-t[r+2],d=t[o]-t[r],u=t[o+1]-t[r+1],f=t[o+2]-t[r+2],_=c*f-h*u,M=h*d-l*f,p=l*u-c*d;n[r]+=_,n[r+1]+=M,n[r+2]+=p,n[a]+=_,n[a+1]+=M,n[a+2]+=p,n[o]+=_,n[o+1]+=M,n[o+2]+=p}for(let s=0;s<n.length;s+=3){let r=Math.sqrt(n[s]*n[s]+n[s+1]*n[s+1]+n[s+2]*n[s+2])||1;n[s]/=r,n[s+1]/=r,n[s+2]/=r}return n}function zp(i){let[e,t]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let o=0;o<i.length;o+=3)for(let l=0;l<3;l++)i[o+l]<e[l]&&(e[l]=i[o+l]),i[o+l]>t[l]&&(t[l]=i[o+l]);let[n,s,r]=e.map((o,l)=>(o+t[l])/2),a=0;for(let o=0;o<i.length;o+=3)a=Math.max(a,(i[o]-n)**2+(i[o+1]-s)**2+(i[o+2]-r)**2);return{center:[n,s,r],radius:Math.sqrt(a),low:e,high:t}}var Bp,kp,aa,jh=et(()=>{Hr();vl();Hn();Jr();ml();Kh();Bp=30,kp=32767,aa=class{constructor(e,t,n){this.growing=e;this.show=n;this.faces=new Int32Array(0);this.points=new Float32Array(0);this.normals=new Float32Array(0);this.origin=new Int32Array(0);this.refined=new Uint8Array(0);this.waiting=new Uint8Array(0);this.around={starts:new Int32Array(1),members:new Int32Array(0)};this.touched=[];this.isTouched=new Uint8Array(0);this.drawable=[];this.blocks=0;this.shown=0;this.carried=[];this.kept=0;this.run=0;this.limits={...Ki,...t}}accept(e){switch(e.type){case"header":return e.header.run>0?this.turn(e.header.run):this.show(e);case"connectivity":return this.begin(e);case"block":case"refinement":return this.grow(e);case"attribute":return this.carried.push(e),this.run>0?void 0:this.show({type:"attribute",name:e.name,semantic:e.semantic,domain:e.domain});case"frame":return this.addFrame(e);case"loss":return this.flush(),this.show(e);case"end":return this.flush(),e.positions&&this.take(e.positions),this.shape||this.finish(),this.show({...e,positions:void 0});default:return this.show(e)}}turn(e){this.flush(),[this.run,this.growing]=[e,!1],this.faces=new Int32Array(0),[this.points,this.normals,this.origin]=[new Float32Array(0),new Float32Array(0),new Int32Array(0)],[this.carried.length,this.shape]=[0,void 0]}flush(){if(!this.growing||this.touched.length+this.drawable.length===0)return;let e=Int32Array.from(this.touched);this.touched=[];let[t,n]=[new Float32Array(3*e.length),new Float32Array(3*e.length)],[s,r]=[new Int32Array(e.length),new Uint8Array(e.length)];e.forEach((o,l)=>{this.isTouched[o]=0,this.renewNormal(o);for(let c=0;c<3;c++)t[3*l+c]=this.points[3*o+c],n[3*l+c]=this.normals[3*o+c];s[l]=this.origin[o],r[l]=this.refined[o]});let a=this.cornersOf(this.drawable);this.drawable=[],this.shown=performance.now(),this.show({type:"grown",vertices:e,positions:t,normals:n,origin:s,refined:r,index:a,blocks:this.blocks},[e,t,n,s,r,a].map(({buffer:o})=>o))}begin({faces:e,vertices:t,loose:n}){this.faces=e,this.origin=new Int32Array(t).fill(-1),this.points=new Float32Array(3*t),this.normals=new Float32Array(3*t),n.vertices.forEach((s,r)=>this.points.set(n.positions.subarray(3*r,3*r+3),3*s)),this.growing&&(this.show({type:"begun",vertices:t,corners:e.length,loose:n}),this.refined=new Uint8Array(t),this.isTouched=new Uint8Array(t),this.waiting=new Uint8Array(e.length/3).fill(3),this.around=Vs(e,t))}touch(e){this.isTouched[e]||(this.isTouched[e]=1,this.touched.push(e))}grow(e){let{vertices:t,positions:n}=e,{points:s,origin:r,growing:a}=this;for(let o=0;o<t.length;o++){let l=t[o];for(let c=0;c<3;c++)s[3*l+c]=n[3*o+c];a?this.settle(l):r[l]=this.blocks}if(e.type==="block")this.blocks++;else if(a)for(let o of t)this.refined[o]=1;a&&performance.now()-this.shown>Bp&&this.flush()}settle(e){let{faces:t,waiting:n,origin:s}=this,{starts:r,members:a}=this.around,o=s[e]<0;o&&(s[e]=this.blocks),this.touch(e);for(let l=r[e];l<r[e+1];l++){let c=Math.floor(a[l]/3);o&&--n[c]===0&&this.drawable.push(c);for(let h=3*c;h<3*c+3;h++)this.touch(t[h])}}renewNormal(e){let{faces:t,waiting:n,normals:s,points:r}=this,{starts:a,members:o}=this.around,[l,c,h]=[0,0,0];for(let u=a[e];u<a[e+1];u++){let f=Math.floor(o[u]/3);if(n[f]>0)continue;let _=3*t[3*f],M=3*t[3*f+1],p=3*t[3*f+2],[g,S,P]=[r[M]-r[_],r[M+1]-r[_+1],r[M+2]-r[_+2]],[w,I,R]=[r[p]-r[_],r[p+1]-r[_+1],r[p+2]-r[_+2]];l+=S*R-P*I,c+=P*w-g*R,h+=g*I-S*w}let d=Math.sqrt(l*l+c*c+h*h)||1;s[3*e]=l/d,s[3*e+1]=c/d,s[3*e+2]=h/d}cornersOf(e){let t=new Uint32Array(3*e.length);for(let n=0;n<t.length;n++)t[n]=this.faces[3*e[Math.floor(n/3)]+n%3];return t}take(e){this.points=new Float32Array(e),this.origin.fill(0)}addFrame({index:e,positions:t,attributes:n}){this.kept+=18*(t.length/3)+n.reduce((d,{values:u})=>d+4*u.length,0),jt(this.limits,"keptBytes",this.kept),this.shape||(this.take(t),this.finish());let{vertices:s,attributes:r}=Nt(this.shape),a=Pi(t,3,s),o=Pi(Jh(this.faces,this.origin,t),3,s),l=new Int16Array(o.length);for(let d=0;d<l.length;d++)l[d]=Math.round(o[d]*kp);let c=n.flatMap(d=>{let u=r.find(({source:f})=>f===d.name);return u?[{...u,values:ra(d,s)}]:[]}),h=[a,l,...c.map(({values:d})=>d)].map(({buffer:d})=>d);this.show({type:"frame",index:e,positions:a,normals:l,attributes:c},h)}finish(){this.flush(),this.growing=!1;let{faces:e,origin:t,points:n,carried:s}=this,r=g=>t[e[g]]>=0,a=Yr(e.length/3),o=t.includes(-1)?a.filter(g=>r(3*g)&&r(3*g+1)&&r(3*g+2)):a,{index:l,vertices:c,pieces:h,attributes:d,own:u}=s.length>0?Zh(e,o,s,n.length/3):this.bare(o),f=Pi(n,3,c),_=u??Pi(Jh(e,t,n),3,c),M=this.shape={index:l,positions:f,normals:_,attributes:d,vertices:c,pieces:h,...zp(f)},p=[l,f,_,...d.map(({values:g})=>g)].map(({buffer:g})=>g);this.run>0&&(this.kept+=p.reduce((g,{byteLength:S})=>g+S,0)),this.show({type:"whole",shape:M,run:this.run},p)}bare(e){let t=3*e.length===this.faces.length?new Uint32Array(this.faces):this.cornersOf(e);return{index:t,pieces:t.length>0?[{part:0,material:0,start:0,count:t.length}]:[],attributes:[]}}}});function xl(i,e,t,n=new Ti(e.kernels)){let s=!1,r,a=()=>{s||r?.close(),s=!0},o=c=>{if(!s)try{c()}catch(h){a(),t(h instanceof Tn?{problem:h.described}:{fault:`${h}`})}},l=(c,h)=>{s||(("over"in c||"through"in c)&&a(),t(c,h))};return o(()=>r=i(e,n,l,o)),{take:c=>o(()=>r?.take(c)),stop:a}}function Qh(i,e,t={}){let n=new Map;i.onmessage=({data:s})=>{if("help"in s)return Qh(s.help,e,t);let{task:r}=s;"start"in s?(t.kernels??=new Ti(s.start.kernels),n.set(r,xl(e,s.start,(a,o=[])=>i.postMessage({task:r,...a},o),t.kernels))):"stop"in s?(n.get(r)?.stop(),n.delete(r)):n.get(r)?.take(s.data)}}function eu(i){let e=self;Qh(e,i),e.postMessage({ready:!0},[])}var oa,tu=et(()=>{jh();xt();ll();na();oa=class{constructor(e,t,n){this.decoder=e;this.start=t;this.out=n;this.taken=0;let{drawing:s,limits:r,reported:a=0}=t;this.reported=-a,s&&(this.drawing=new aa(s==="growing",r,(o,l)=>this.say({picture:o},l)))}take(e){e?this.decoder.receiveData(e):this.decoder.receiveEof(),this.taken+=e?.length??0}close(){this.decoder.release()}report(){try{return this.pass()}catch(e){throw this.drawing?.flush(),this.out({reported:this.reported}),e}}pass(){for(;;){let e=this.decoder.nextEvent();if(typeof e=="string")return this.drawing?.flush(),e===Ci&&this.say({taken:this.taken}),e===ts&&this.say({over:!0}),e;if(this.drawing)this.drawing.accept(e);else if(e.type==="frame"){let t=Float32Array.from(e.positions);this.say({event:{...e,positions:t}},[t.buffer])}else this.say({event:e});this.reported<0&&this.drawing?.flush(),(e.type!=="block"||this.start.drawing!=="whole")&&this.reported++}}say(e,t){this.reported>=0&&this.out(e,t)}}});function nu(i,e,t){let n=new oa(new sa(e,i.limits),i,t);return{close:()=>n.close(),take(s){n.take(s),n.report()}}}function iu(i,e){return xl(nu,i,e)}function su(){eu(nu)}var ru=et(()=>{tu();yl()});var au={};th(au,{BsmError:()=>Tn,CorruptError:()=>Ie,DEFAULT_LIMITS:()=>Ki,FormatError:()=>Or,Helper:()=>sh,Kernels:()=>Ti,LimitError:()=>Ei,NEED_BLOCK:()=>rh,NumericError:()=>Br,Team:()=>ah,TruncatedError:()=>Ai,UnsupportedError:()=>dn,bsm:()=>Fr,checkLimit:()=>oh,errorLike:()=>qi,hasVectors:()=>Gn,openDesk:()=>iu,serve:()=>su});var ou=et(()=>{xt();Hn();ll();zs();yl();ru()});xt();Yi();xt();Vr();Gr();function fh(i){try{let e=Zi(i,Vn.length,i.length);if(!e)return;let t=e.end+Math.floor(e.value/16);if(t>i.length)return i[0]===Vn[0]&&e.value%16===1?void 0:{build:"whole",vertices:0};let n=new Map($i(i.subarray(e.end,t)).map(([u,f])=>[Number(u.value),f.type==="array"?f.value[0]:f])),s=u=>Number(n.get(u)?.value??0),{vertices:r,paper:a,sequence:o,attributes:l,light:c}=kr;return{build:s(a.key)>0||n.has(l.key)?"whole":n.has(o.key)?"moving":s(c.key)===1?"quick":"small",vertices:s(r.key)}}catch(e){if(!(e instanceof Tn))throw e;return{build:"whole",vertices:0}}}zs();var Vp={whole:()=>new Worker(new URL("./worker.js",import.meta.url),{type:"module",name:"BSM"}),small:()=>new Worker(new URL("./small-worker.js",import.meta.url),{type:"module",name:"BSM-small"}),quick:()=>new Worker(new URL("./quick-worker.js",import.meta.url),{type:"module",name:"BSM-quick"}),moving:()=>new Worker(new URL("./moving-worker.js",import.meta.url),{type:"module",name:"BSM-moving"})},lu={whole:()=>new URL("./kernels.wasm",import.meta.url),small:()=>new URL("./small.wasm",import.meta.url),quick:()=>new URL("./quick.wasm",import.meta.url),moving:()=>new URL("./moving.wasm",import.meta.url),scalar:()=>new URL("./kernels-scalar.wasm",import.meta.url)};function Gp(i){return Gn()?i:"whole"}function Hp(i){if(!(typeof Worker>"u"))try{return i()}catch{return}}var bl="the server sent an HTML page; is the address right?";function Ml(i){return/^\s*<(!|html)/i.test(new TextDecoder().decode(i.subarray(0,64)))}async function Wp(i){if(i.protocol==="file:"){let{readFile:n}=process.getBuiltinModule("node:fs/promises");return WebAssembly.compile(await n(i))}let e=await fetch(i);if(!e.ok)throw new Error(`${i}: ${e.status} ${e.statusText}; the decoder's files must lie there`);let t=await e.arrayBuffer();return WebAssembly.compile(t).catch(n=>{throw new Error(`${i}: ${Ml(new Uint8Array(t))?bl:n.message}`)})}function Sl(i){let e=new Map;return t=>{let n=e.get(t)??i(t);return e.set(t,n),n.catch(()=>e.delete(t)),n}}var Xp=i=>i==="quick"&&Gn()?Promise.resolve().then(()=>(ou(),au)):Promise.resolve().then(()=>(xt(),lh)),cu={worker:i=>Hp(Vp[Gp(i)]),kernels:Sl(i=>Wp(Gn()?lu[i]():lu.scalar())),local:Xp};zs();var qp=4,Yp=8192,Gs=class{constructor(e=cu,t=qp){this.source=e;this.limit=t;this.hands=[];this.streams=new Set;this.waiting=[];this.task=0;this.alone=!1;this.warned=!1}setLimit(e){this.limit=Math.max(1,e)}async preload(e="small"){!this.alone&&!this.hands.some(t=>t.build===e)&&this.start(e),await this.source.kernels(e)}open(e,t={}){let n=new la(e,t,{begin:(s,r)=>{this.begin(s,r)},end:s=>this.end(s)});return this.streams.add(n),n}dispose(){for(let{worker:e}of this.hands.splice(0))e.terminate();this.waiting.length=0;for(let e of[...this.streams])e.fail(new Error("the decoder's threads were stopped"))}async begin(e,t){let n;try{n=await this.source.kernels(t.build)}catch(s){return e.fail(s instanceof Error?s:new Error(`${s}`))}e.prepare(n,t),e.closed||this.place(e)}place(e){let{build:t}=e.need,n=this.alone?void 0:this.free(t);if(this.alone)return void this.stay(e);if(!n)return void this.waiting.push(e);let s=this.helpersFor(e,n);e.task=this.task++;let r=s.map(a=>{let{port1:o,port2:l}=new MessageChannel;return a.worker.postMessage({help:l},[l]),o});for(let a of[n,...s])a.streams.add(e);e.work((a,o)=>n.worker.postMessage(a,o),r)}free(e){let t=this.hands.filter(s=>s.streams.size===0),n=t.find(s=>s.build===e);if(n)return n;if(this.hands.length>=this.limit){if(t.length===0)return;this.hands.splice(this.hands.indexOf(t[0]),1),t[0].worker.terminate()}return this.start(e)}helpersFor({need:e,wishes:t},n){let s=Math.min(ph(),this.limit)-1;if(e.build==="quick"||e.vertices<(t.worthwhile??Yp)||this.waiting.length>0)return[];let r=this.hands.filter(o=>o!==n&&o.streams.size>0).length;n.streams.add(wl);let a=[];for(;a.length<s-r;){let o=this.free(e.build);if(!o)break;o.streams.add(wl),a.push(o)}for(let o of[n,...a])o.streams.delete(wl);return a}start(e){let t=this.source.worker(e);if(!t)return this.settle();let n={build:e,worker:t,ready:!1,streams:new Set};return t.onmessage=({data:s})=>{if("ready"in s)n.ready=!0;else for(let r of n.streams)r.task===s.task&&r.hear(s)},t.onerror=s=>{s.preventDefault?.(),this.lose(n,new Error(`the decoder's thread does not run: ${s.message??"it was stopped"}`))},this.hands.push(n),n}settle(){this.alone=!0,!this.warned&&typeof Worker<"u"&&console.warn("BSM: this page may have no threads of its own, it decodes in the one that draws"),this.warned=!0}lose(e,t){let n=[...e.streams];e.worker.terminate(),e.streams.clear(),this.hands.includes(e)&&this.hands.splice(this.hands.indexOf(e),1);for(let s of this.hands)for(let r of n)s.streams.delete(r);e.ready||this.settle();for(let s of n)(e.ready||s.begun)&&s.fail(t);if(!e.ready)for(let s of[...n,...this.waiting.splice(0)])this.stay(s)}async stay(e){let t=e.task=this.task++,n=await this.source.local(e.need.build).catch(a=>e.fail(new Error(`${a}`))),s,r=a=>e.task===t?e.hear(a):void 0;e.work(a=>{setTimeout(()=>{e.closed||"stop"in a?s?.stop():"start"in a?s=n?.openDesk({...a.start,helpers:[]},r):"data"in a&&s?.take(a.data)})},[])}end(e){e.closed&&this.streams.delete(e);let t=this.hands.filter(r=>r.streams.delete(e));this.hands.push(...this.hands.splice(0).filter(r=>!t.includes(r)),...t);let n=this.waiting.indexOf(e);n>=0&&this.waiting.splice(n,1);let s=()=>this.hands.length<this.limit||this.hands.some(({streams:r})=>r.size===0);for(let r;s()&&(r=this.waiting.shift());)this.place(r)}},la=class{constructor(e,t,n){this.listener=e;this.wishes=t;this.places=n;this.closed=!1;this.begun=!1;this.task=-1;this.need={build:"whole",vertices:0};this.pieces=[];this.known=!1;this.reported=0}receiveData(e){this.take(e)}receiveEof(){this.take(null)}close(){this.closed||(this.closed=!0,this.say?.({task:this.task,stop:!0},[]),this.pieces.length=0,this.places.end(this))}fail(e){this.closed||(this.close(),this.listener.onError(e))}prepare(e,t){[this.kernels,this.need]=[e,t]}work(e,t){let{tolerant:n,drawing:s,worthwhile:r,limits:a={}}=this.wishes,{kernels:o,reported:l}=this;if(!(!o||this.closed)){this.say=e,e({task:this.task,start:{kernels:o,limits:a,tolerant:n,drawing:s,reported:l,worthwhile:r,helpers:t}},t);for(let c of this.pieces)e({task:this.task,data:c},[])}}hear(e){let{listener:t}=this;this.closed||(this.begun=!0,"picture"in e?t.onPicture?.(e.picture):"event"in e?t.onEvent?.(e.event):"taken"in e?t.onTaken?.(e.taken):"reported"in e?this.reported=e.reported:"problem"in e?this.need.build!=="whole"?this.restart():this.fail(qi(Ml(hu(this.pieces.slice(0,64)))?{...e.problem,problem:bl,place:{}}:e.problem)):"fault"in e?this.fail(new Error(e.fault)):"over"in e&&(this.close(),t.onEnd?.()))}take(e){if(!this.closed){if(this.pieces.push(e),this.say)this.say({task:this.task,data:e},[]);else if(!this.known){let t=this.wishes.tolerant?{build:"whole",vertices:0}:fh(hu(this.pieces));this.known=t!==void 0||e===null,this.known&&this.places.begin(this,t??this.need)}}}restart(){this.say?.({task:this.task,stop:!0},[]),[this.say,this.task]=[void 0,-1],this.places.end(this),this.places.begin(this,{...this.need,build:"whole"})}},wl=new la({onError:()=>{}},{},{begin:()=>{},end:()=>{}});function hu(i){let e=i.flatMap(s=>s??[]);if(e.length===1)return e[0];let t=new Uint8Array(e.reduce((s,{length:r})=>s+r,0)),n=0;for(let s of e)t.set(s,n),n+=s.length;return t}xt();zs();var uu=KERNELS.kernels.url!==void 0;async function ca(i,e){let t=await fetch(i,e);if(!t.ok)throw new Error(`${t.status} ${t.statusText}`);return t}async function oi({url:i,data:e}){return e!==void 0?Uint8Array.from(atob(e),t=>t.charCodeAt(0)):new Uint8Array(await(await ca(i)).arrayBuffer())}var $p=Sl(async i=>WebAssembly.compile(await oi(i==="small"&&KERNELS.small||KERNELS[Gn()?"kernels":"kernels-scalar"]))),El={worker(){let i=URL.createObjectURL(new Blob([`(${Fr})().serve()`],{type:"text/javascript"}));try{return new Worker(i,{name:"BSM"})}catch{return}finally{URL.revokeObjectURL(i)}},kernels:i=>$p(i==="small"&&Gn()&&KERNELS.small?i:"whole"),local:()=>Promise.resolve({openDesk:rl})};var xi={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},bi={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},Fu=0,Ql=1,Ou=2;var gr=1,Bu=2,Ts=3,Nn=0,Yt=1,Qt=2,ki=0,Rs=1,ec=2,tc=3,nc=4,ku=5;var zi=100,zu=101,Vu=102,Gu=103,Hu=104,Wu=200,Xu=201,qu=202,Yu=203,ic=204,sc=205,$u=206,Zu=207,Ku=208,Ju=209,ju=210,Qu=211,ed=212,td=213,nd=214,La=0,Da=1,Na=2,gs=3,Ua=4,Fa=5,Oa=6,Ba=7,rc=0,id=1,sd=2,Un=0,ac=1,oc=2,lc=3,cc=4,hc=5,uc=6,_r=7;var dc=300,Vi=301,Cs=302,Ps=303,ao=304,_s=1e3,Cn=1001,ka=1002,It=1003,rd=1004;var yr=1005;var wt=1006,oo=1007;var ei=1008;var en=1009,fc=1010,pc=1011,Is=1012,lo=1013,Mn=1014,Sn=1015,hn=1016,co=1017,ho=1018,Gi=1020,mc=35902,gc=35899,_c=1021,yc=1022,wn=1023,Jn=1026,ti=1027,vc=1028,uo=1029,Mi=1030,fo=1031;var po=1033,vr=33776,xr=33777,br=33778,Mr=33779,mo=35840,go=35841,_o=35842,yo=35843,vo=36196,xo=37492,bo=37496,Mo=37488,So=37489,Sr=37490,wo=37491,Eo=37808,Ao=37809,To=37810,Ro=37811,Co=37812,Po=37813,Io=37814,Lo=37815,Do=37816,No=37817,Uo=37818,Fo=37819,Oo=37820,Bo=37821,ko=36492,zo=36494,Vo=36495,Go=36283,Ho=36284,wr=36285,Wo=36286;var Ks=2300,za=2301,Pa=2302,ql=2303,Yl=2400,$l=2401,Zl=2402;var ad=3200;var Xo=0,od=1,En="",kt="srgb",Js="srgb-linear",js="linear",st="srgb";var Ia=7680;var ld=519,cd=512,hd=513,ud=514,xc=515,dd=516,fd=517,bc=518,Mc=519,pd=35044;var Sc="300 es",pn=2e3,ys=2001;function Zp(i){for(let e=i.length-1;e>=0;--e)if(i[e]>=65535)return!0;return!1}function Kp(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}function Qs(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function md(){let i=Qs("canvas");return i.style.display="block",i}var du={},vs=null;function wc(...i){let e="THREE."+i.shift();vs?vs("log",e,...i):console.log(e,...i)}function gd(i){let e=i[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=i[1];t&&t.isStackTrace?i[0]+=" "+t.getLocation():i[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return i}function Ne(...i){i=gd(i);let e="THREE."+i.shift();if(vs)vs("warn",e,...i);else{let t=i[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...i)}}function Oe(...i){i=gd(i);let e="THREE."+i.shift();if(vs)vs("error",e,...i);else{let t=i[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...i)}}function Ys(...i){let e=i.join(" ");e in du||(du[e]=!0,Ne(...i))}function _d(i,e,t){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(e,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:n()}}setTimeout(r,t)})}var yd={[La]:La,[Na]:Oa,[Ua]:Ua,[gs]:Fa,[Da]:Da,[Oa]:Na,[Ba]:Ba,[Fa]:gs},bn=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n===void 0?!1:n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let s=n[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let s=n.slice(0);for(let r=0,a=s.length;r<a;r++)s[r].call(this,e);e.target=null}}},Ot=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],fu=1234567,$s=Math.PI/180,xs=180/Math.PI;function Ls(){let i=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(Ot[i&255]+Ot[i>>8&255]+Ot[i>>16&255]+Ot[i>>24&255]+"-"+Ot[e&255]+Ot[e>>8&255]+"-"+Ot[e>>16&15|64]+Ot[e>>24&255]+"-"+Ot[t&63|128]+Ot[t>>8&255]+"-"+Ot[t>>16&255]+Ot[t>>24&255]+Ot[n&255]+Ot[n>>8&255]+Ot[n>>16&255]+Ot[n>>24&255]).toLowerCase()}function We(i,e,t){return Math.max(e,Math.min(t,i))}function Ec(i,e){return(i%e+e)%e}function Jp(i,e,t,n,s){return n+(i-e)*(s-n)/(t-e)}function jp(i,e,t){return i!==e?(t-i)/(e-i):0}function Zs(i,e,t){return(1-t)*i+t*e}function Qp(i,e,t,n){return Zs(i,e,1-Math.exp(-t*n))}function em(i,e=1){return e-Math.abs(Ec(i,e*2)-e)}function tm(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*(3-2*i))}function nm(i,e,t){return i<=e?0:i>=t?1:(i=(i-e)/(t-e),i*i*i*(i*(i*6-15)+10))}function im(i,e){return i+Math.floor(Math.random()*(e-i+1))}function sm(i,e){return i+Math.random()*(e-i)}function rm(i){return i*(.5-Math.random())}function am(i){i!==void 0&&(fu=i);let e=fu+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function om(i){return i*$s}function lm(i){return i*xs}function cm(i){return i>0&&Number.isInteger(i)&&2**Math.round(Math.log2(i))===i}function hm(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function Ac(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function um(i,e,t,n,s){let r=Math.cos,a=Math.sin,o=r(t/2),l=a(t/2),c=r((e+n)/2),h=a((e+n)/2),d=r((e-n)/2),u=a((e-n)/2),f=r((n-e)/2),_=a((n-e)/2);switch(s){case"XYX":i.set(o*h,l*d,l*u,o*c);break;case"YZY":i.set(l*u,o*h,l*d,o*c);break;case"ZXZ":i.set(l*d,l*u,o*h,o*c);break;case"XZX":i.set(o*h,l*_,l*f,o*c);break;case"YXY":i.set(l*f,o*h,l*_,o*c);break;case"ZYZ":i.set(l*_,l*f,o*h,o*c);break;default:Ne("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Tc(i){switch(i.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function vd(i,e){if(e.constructor===Float32Array)return i;let t=Tc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(i/t,-1)}function xd(i,e){if(e.constructor===Float32Array)return i;let t=Tc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(i*t)}var Fn={DEG2RAD:$s,RAD2DEG:xs,generateUUID:Ls,clamp:We,euclideanModulo:Ec,mapLinear:Jp,inverseLerp:jp,lerp:Zs,damp:Qp,pingpong:em,smoothstep:tm,smootherstep:nm,randInt:im,randFloat:sm,randFloatSpread:rm,seededRandom:am,degToRad:om,radToDeg:lm,isPowerOfTwo:cm,ceilPowerOfTwo:hm,floorPowerOfTwo:Ac,setQuaternionFromProperEuler:um,normalize:xd,denormalize:vd},Be=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,s=e.elements;return this.x=s[0]*t+s[3]*n+s[6],this.y=s[1]*t+s[4]*n+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=We(this.x,e.x,t.x),this.y=We(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=We(this.x,e,t),this.y=We(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(We(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(We(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),s=Math.sin(t),r=this.x-e.x,a=this.y-e.y;return this.x=r*n-a*s+e.x,this.y=r*s+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},on=class{constructor(e=0,t=0,n=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=s}static slerpFlat(e,t,n,s,r,a,o){let l=n[s+0],c=n[s+1],h=n[s+2],d=n[s+3],u=r[a+0],f=r[a+1],_=r[a+2],M=r[a+3];if(d!==M||l!==u||c!==f||h!==_){let p=l*u+c*f+h*_+d*M;p<0&&(u=-u,f=-f,_=-_,M=-M,p=-p);let g=1-o;if(p<.9995){let S=Math.acos(p),P=Math.sin(S);g=Math.sin(g*S)/P,o=Math.sin(o*S)/P,l=l*g+u*o,c=c*g+f*o,h=h*g+_*o,d=d*g+M*o}else{l=l*g+u*o,c=c*g+f*o,h=h*g+_*o,d=d*g+M*o;let S=1/Math.sqrt(l*l+c*c+h*h+d*d);l*=S,c*=S,h*=S,d*=S}}e[t]=l,e[t+1]=c,e[t+2]=h,e[t+3]=d}static multiplyQuaternionsFlat(e,t,n,s,r,a){let o=n[s],l=n[s+1],c=n[s+2],h=n[s+3],d=r[a],u=r[a+1],f=r[a+2],_=r[a+3];return e[t]=o*_+h*d+l*f-c*u,e[t+1]=l*_+h*u+c*d-o*f,e[t+2]=c*_+h*f+o*u-l*d,e[t+3]=h*_-o*d-l*u-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,s){return this._x=e,this._y=t,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,s=e._y,r=e._z,a=e._order,o=Math.cos,l=Math.sin,c=o(n/2),h=o(s/2),d=o(r/2),u=l(n/2),f=l(s/2),_=l(r/2);switch(a){case"XYZ":this._x=u*h*d+c*f*_,this._y=c*f*d-u*h*_,this._z=c*h*_+u*f*d,this._w=c*h*d-u*f*_;break;case"YXZ":this._x=u*h*d+c*f*_,this._y=c*f*d-u*h*_,this._z=c*h*_-u*f*d,this._w=c*h*d+u*f*_;break;case"ZXY":this._x=u*h*d-c*f*_,this._y=c*f*d+u*h*_,this._z=c*h*_+u*f*d,this._w=c*h*d-u*f*_;break;case"ZYX":this._x=u*h*d-c*f*_,this._y=c*f*d+u*h*_,this._z=c*h*_-u*f*d,this._w=c*h*d+u*f*_;break;case"YZX":this._x=u*h*d+c*f*_,this._y=c*f*d+u*h*_,this._z=c*h*_-u*f*d,this._w=c*h*d-u*f*_;break;case"XZY":this._x=u*h*d-c*f*_,this._y=c*f*d-u*h*_,this._z=c*h*_+u*f*d,this._w=c*h*d+u*f*_;break;default:Ne("Quaternion: .setFromEuler() encountered an unknown order: "+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,s=Math.sin(n);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],s=t[4],r=t[8],a=t[1],o=t[5],l=t[9],c=t[2],h=t[6],d=t[10],u=n+o+d;if(u>0){let f=.5/Math.sqrt(u+1);this._w=.25/f,this._x=(h-l)*f,this._y=(r-c)*f,this._z=(a-s)*f}else if(n>o&&n>d){let f=2*Math.sqrt(1+n-o-d);this._w=(h-l)/f,this._x=.25*f,this._y=(s+a)/f,this._z=(r+c)/f}else if(o>d){let f=2*Math.sqrt(1+o-n-d);this._w=(r-c)/f,this._x=(s+a)/f,this._y=.25*f,this._z=(l+h)/f}else{let f=2*Math.sqrt(1+d-n-o);this._w=(a-s)/f,this._x=(r+c)/f,this._y=(l+h)/f,this._z=.25*f}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(We(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let s=Math.min(1,t/n);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,s=e._y,r=e._z,a=e._w,o=t._x,l=t._y,c=t._z,h=t._w;return this._x=n*h+a*o+s*c-r*l,this._y=s*h+a*l+r*o-n*c,this._z=r*h+a*c+n*l-s*o,this._w=a*h-n*o-s*l-r*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,s=e._y,r=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,s=-s,r=-r,a=-a,o=-o);let l=1-t;if(o<.9995){let c=Math.acos(o),h=Math.sin(c);l=Math.sin(l*c)/h,t=Math.sin(t*c)/h,this._x=this._x*l+n*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+a*t,this._onChangeCallback()}else this._x=this._x*l+n*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},z=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(pu.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(pu.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6]*s,this.y=r[1]*t+r[4]*n+r[7]*s,this.z=r[2]*t+r[5]*n+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=e.elements,a=1/(r[3]*t+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*n+r[8]*s+r[12])*a,this.y=(r[1]*t+r[5]*n+r[9]*s+r[13])*a,this.z=(r[2]*t+r[6]*n+r[10]*s+r[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,s=this.z,r=e.x,a=e.y,o=e.z,l=e.w,c=2*(a*s-o*n),h=2*(o*t-r*s),d=2*(r*n-a*t);return this.x=t+l*c+a*d-o*h,this.y=n+l*h+o*c-r*d,this.z=s+l*d+r*h-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*n+r[8]*s,this.y=r[1]*t+r[5]*n+r[9]*s,this.z=r[2]*t+r[6]*n+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=We(this.x,e.x,t.x),this.y=We(this.y,e.y,t.y),this.z=We(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=We(this.x,e,t),this.y=We(this.y,e,t),this.z=We(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(We(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,s=e.y,r=e.z,a=t.x,o=t.y,l=t.z;return this.x=s*l-r*o,this.y=r*a-n*l,this.z=n*o-s*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return Al.copy(this).projectOnVector(e),this.sub(Al)}reflect(e){return this.sub(Al.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(We(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,s=this.z-e.z;return t*t+n*n+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let s=Math.sin(t)*e;return this.x=s*Math.sin(n),this.y=Math.cos(t)*e,this.z=s*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Al=new z,pu=new on,ze=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,s,r,a,o,l,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,a,o,l,c)}set(e,t,n,s,r,a,o,l,c){let h=this.elements;return h[0]=e,h[1]=s,h[2]=o,h[3]=t,h[4]=r,h[5]=l,h[6]=n,h[7]=a,h[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,a=n[0],o=n[3],l=n[6],c=n[1],h=n[4],d=n[7],u=n[2],f=n[5],_=n[8],M=s[0],p=s[3],g=s[6],S=s[1],P=s[4],w=s[7],I=s[2],R=s[5],y=s[8];return r[0]=a*M+o*S+l*I,r[3]=a*p+o*P+l*R,r[6]=a*g+o*w+l*y,r[1]=c*M+h*S+d*I,r[4]=c*p+h*P+d*R,r[7]=c*g+h*w+d*y,r[2]=u*M+f*S+_*I,r[5]=u*p+f*P+_*R,r[8]=u*g+f*w+_*y,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],a=e[4],o=e[5],l=e[6],c=e[7],h=e[8];return t*a*h-t*o*c-n*r*h+n*o*l+s*r*c-s*a*l}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],a=e[4],o=e[5],l=e[6],c=e[7],h=e[8],d=h*a-o*c,u=o*l-h*r,f=c*r-a*l,_=t*d+n*u+s*f;if(_===0)return this.set(0,0,0,0,0,0,0,0,0);let M=1/_;return e[0]=d*M,e[1]=(s*c-h*n)*M,e[2]=(o*n-s*a)*M,e[3]=u*M,e[4]=(h*t-s*l)*M,e[5]=(s*r-o*t)*M,e[6]=f*M,e[7]=(n*l-c*t)*M,e[8]=(a*t-n*r)*M,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,s,r,a,o){let l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*a+c*o)+a+e,-s*c,s*l,-s*(-c*a+l*o)+o+t,0,0,1),this}scale(e,t){return Ys("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(Tl.makeScale(e,t)),this}rotate(e){return Ys("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(Tl.makeRotation(-e)),this}translate(e,t){return Ys("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(Tl.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<9;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},Tl=new ze,mu=new ze().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),gu=new ze().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function dm(){let i={enabled:!0,workingColorSpace:Js,spaces:{},convert:function(s,r,a){return this.enabled===!1||r===a||!r||!a||(this.spaces[r].transfer===st&&(s.r=Kn(s.r),s.g=Kn(s.g),s.b=Kn(s.b)),this.spaces[r].primaries!==this.spaces[a].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[a].fromXYZ)),this.spaces[a].transfer===st&&(s.r=ms(s.r),s.g=ms(s.g),s.b=ms(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===En?js:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,a){return s.copy(this.spaces[a].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],n=[.3127,.329];return i.define({[Js]:{primaries:e,whitePoint:n,transfer:js,toXYZ:mu,fromXYZ:gu,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:kt},outputColorSpaceConfig:{drawingBufferColorSpace:kt}},[kt]:{primaries:e,whitePoint:n,transfer:st,toXYZ:mu,fromXYZ:gu,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:kt}}}),i}var Ke=dm();function Kn(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function ms(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var ns,Va=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{ns===void 0&&(ns=Qs("canvas")),ns.width=e.width,ns.height=e.height;let s=ns.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),n=ns}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=Qs("canvas");t.width=e.width,t.height=e.height;let n=t.getContext("2d");n.drawImage(e,0,0,e.width,e.height);let s=n.getImageData(0,0,e.width,e.height),r=s.data;for(let a=0;a<r.length;a++)r[a]=Kn(r[a]/255)*255;return n.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let n=0;n<t.length;n++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[n]=Math.floor(Kn(t[n]/255)*255):t[n]=Kn(t[n]);return{data:t,width:e.width,height:e.height}}else return Ne("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},fm=0,bs=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:fm++}),this.uuid=Ls(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let a=0,o=s.length;a<o;a++)s[a].isDataTexture?r.push(Rl(s[a].image)):r.push(Rl(s[a]))}else r=Rl(s);n.url=r}return t||(e.images[this.uuid]=n),n}};function Rl(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?Va.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(Ne("Texture: Unable to serialize Texture."),{})}var pm=0,Cl=new z,zt=class i extends bn{constructor(e=i.DEFAULT_IMAGE,t=i.DEFAULT_MAPPING,n=Cn,s=Cn,r=wt,a=ei,o=wn,l=en,c=i.DEFAULT_ANISOTROPY,h=En){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:pm++}),this.uuid=Ls(),this.name="",this.source=new bs(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=a,this.anisotropy=c,this.format=o,this.internalFormat=null,this.type=l,this.offset=new Be(0,0),this.repeat=new Be(1,1),this.center=new Be(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new ze,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Cl).x}get height(){return this.source.getSize(Cl).y}get depth(){return this.source.getSize(Cl).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){Ne(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ne(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&n&&s.isVector2&&n.isVector2||s&&n&&s.isVector3&&n.isVector3||s&&n&&s.isMatrix3&&n.isMatrix3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==dc)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case _s:e.x=e.x-Math.floor(e.x);break;case Cn:e.x=e.x<0?0:1;break;case ka:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case _s:e.y=e.y-Math.floor(e.y);break;case Cn:e.y=e.y<0?0:1;break;case ka:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};zt.DEFAULT_IMAGE=null;zt.DEFAULT_MAPPING=dc;zt.DEFAULT_ANISOTROPY=1;var gt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,s=1){this.x=e,this.y=t,this.z=n,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,s){return this.x=e,this.y=t,this.z=n,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,s=this.z,r=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*s+a[12]*r,this.y=a[1]*t+a[5]*n+a[9]*s+a[13]*r,this.z=a[2]*t+a[6]*n+a[10]*s+a[14]*r,this.w=a[3]*t+a[7]*n+a[11]*s+a[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,s,r,l=e.elements,c=l[0],h=l[4],d=l[8],u=l[1],f=l[5],_=l[9],M=l[2],p=l[6],g=l[10];if(Math.abs(h-u)<.01&&Math.abs(d-M)<.01&&Math.abs(_-p)<.01){if(Math.abs(h+u)<.1&&Math.abs(d+M)<.1&&Math.abs(_+p)<.1&&Math.abs(c+f+g-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let P=(c+1)/2,w=(f+1)/2,I=(g+1)/2,R=(h+u)/4,y=(d+M)/4,T=(_+p)/4;return P>w&&P>I?P<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(P),s=R/n,r=y/n):w>I?w<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(w),n=R/s,r=T/s):I<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(I),n=y/r,s=T/r),this.set(n,s,r,t),this}let S=Math.sqrt((p-_)*(p-_)+(d-M)*(d-M)+(u-h)*(u-h));return Math.abs(S)<.001&&(S=1),this.x=(p-_)/S,this.y=(d-M)/S,this.z=(u-h)/S,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=We(this.x,e.x,t.x),this.y=We(this.y,e.y,t.y),this.z=We(this.z,e.z,t.z),this.w=We(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=We(this.x,e,t),this.y=We(this.y,e,t),this.z=We(this.z,e,t),this.w=We(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(We(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Ga=class extends bn{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:wt,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new gt(0,0,e,t),this.scissorTest=!1,this.viewport=new gt(0,0,e,t),this.textures=[];let s=n.count;for(let r=0;r<s;r++)this.textures[r]=new zt({width:e,height:t,depth:n.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:wt,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let n=0;n<this.textures.length;n++)this.textures[n].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=n,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new bs(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},ln=class extends Ga{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},er=class extends zt{constructor(e=null,t=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=It,this.minFilter=It,this.wrapR=Cn,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var Ha=class extends zt{constructor(e=null,t=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:s},this.magFilter=It,this.minFilter=It,this.wrapR=Cn,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var ut=class i{static{this.prototype.isMatrix4=!0}constructor(e,t,n,s,r,a,o,l,c,h,d,u,f,_,M,p){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,s,r,a,o,l,c,h,d,u,f,_,M,p)}set(e,t,n,s,r,a,o,l,c,h,d,u,f,_,M,p){let g=this.elements;return g[0]=e,g[4]=t,g[8]=n,g[12]=s,g[1]=r,g[5]=a,g[9]=o,g[13]=l,g[2]=c,g[6]=h,g[10]=d,g[14]=u,g[3]=f,g[7]=_,g[11]=M,g[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,s=1/is.setFromMatrixColumn(e,0).length(),r=1/is.setFromMatrixColumn(e,1).length(),a=1/is.setFromMatrixColumn(e,2).length();return t[0]=n[0]*s,t[1]=n[1]*s,t[2]=n[2]*s,t[3]=0,t[4]=n[4]*r,t[5]=n[5]*r,t[6]=n[6]*r,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,s=e.y,r=e.z,a=Math.cos(n),o=Math.sin(n),l=Math.cos(s),c=Math.sin(s),h=Math.cos(r),d=Math.sin(r);if(e.order==="XYZ"){let u=a*h,f=a*d,_=o*h,M=o*d;t[0]=l*h,t[4]=-l*d,t[8]=c,t[1]=f+_*c,t[5]=u-M*c,t[9]=-o*l,t[2]=M-u*c,t[6]=_+f*c,t[10]=a*l}else if(e.order==="YXZ"){let u=l*h,f=l*d,_=c*h,M=c*d;t[0]=u+M*o,t[4]=_*o-f,t[8]=a*c,t[1]=a*d,t[5]=a*h,t[9]=-o,t[2]=f*o-_,t[6]=M+u*o,t[10]=a*l}else if(e.order==="ZXY"){let u=l*h,f=l*d,_=c*h,M=c*d;t[0]=u-M*o,t[4]=-a*d,t[8]=_+f*o,t[1]=f+_*o,t[5]=a*h,t[9]=M-u*o,t[2]=-a*c,t[6]=o,t[10]=a*l}else if(e.order==="ZYX"){let u=a*h,f=a*d,_=o*h,M=o*d;t[0]=l*h,t[4]=_*c-f,t[8]=u*c+M,t[1]=l*d,t[5]=M*c+u,t[9]=f*c-_,t[2]=-c,t[6]=o*l,t[10]=a*l}else if(e.order==="YZX"){let u=a*l,f=a*c,_=o*l,M=o*c;t[0]=l*h,t[4]=M-u*d,t[8]=_*d+f,t[1]=d,t[5]=a*h,t[9]=-o*h,t[2]=-c*h,t[6]=f*d+_,t[10]=u-M*d}else if(e.order==="XZY"){let u=a*l,f=a*c,_=o*l,M=o*c;t[0]=l*h,t[4]=-d,t[8]=c*h,t[1]=u*d+M,t[5]=a*h,t[9]=f*d-_,t[2]=_*d-f,t[6]=o*h,t[10]=M*d+u}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(mm,e,gm)}lookAt(e,t,n){let s=this.elements;return sn.subVectors(e,t),sn.lengthSq()===0&&(sn.z=1),sn.normalize(),li.crossVectors(n,sn),li.lengthSq()===0&&(Math.abs(n.z)===1?sn.x+=1e-4:sn.z+=1e-4,sn.normalize(),li.crossVectors(n,sn)),li.normalize(),ha.crossVectors(sn,li),s[0]=li.x,s[4]=ha.x,s[8]=sn.x,s[1]=li.y,s[5]=ha.y,s[9]=sn.y,s[2]=li.z,s[6]=ha.z,s[10]=sn.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,s=t.elements,r=this.elements,a=n[0],o=n[4],l=n[8],c=n[12],h=n[1],d=n[5],u=n[9],f=n[13],_=n[2],M=n[6],p=n[10],g=n[14],S=n[3],P=n[7],w=n[11],I=n[15],R=s[0],y=s[4],T=s[8],X=s[12],F=s[1],V=s[5],$=s[9],Q=s[13],U=s[2],J=s[6],se=s[10],Z=s[14],he=s[3],K=s[7],oe=s[11],le=s[15];return r[0]=a*R+o*F+l*U+c*he,r[4]=a*y+o*V+l*J+c*K,r[8]=a*T+o*$+l*se+c*oe,r[12]=a*X+o*Q+l*Z+c*le,r[1]=h*R+d*F+u*U+f*he,r[5]=h*y+d*V+u*J+f*K,r[9]=h*T+d*$+u*se+f*oe,r[13]=h*X+d*Q+u*Z+f*le,r[2]=_*R+M*F+p*U+g*he,r[6]=_*y+M*V+p*J+g*K,r[10]=_*T+M*$+p*se+g*oe,r[14]=_*X+M*Q+p*Z+g*le,r[3]=S*R+P*F+w*U+I*he,r[7]=S*y+P*V+w*J+I*K,r[11]=S*T+P*$+w*se+I*oe,r[15]=S*X+P*Q+w*Z+I*le,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[12],a=e[1],o=e[5],l=e[9],c=e[13],h=e[2],d=e[6],u=e[10],f=e[14],_=e[3],M=e[7],p=e[11],g=e[15],S=l*f-c*u,P=o*f-c*d,w=o*u-l*d,I=a*f-c*h,R=a*u-l*h,y=a*d-o*h;return t*(M*S-p*P+g*w)-n*(_*S-p*I+g*R)+s*(_*P-M*I+g*y)-r*(_*w-M*R+p*y)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],s=e[8],r=e[1],a=e[5],o=e[9],l=e[2],c=e[6],h=e[10];return t*(a*h-o*c)-n*(r*h-o*l)+s*(r*c-a*l)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],s=e[2],r=e[3],a=e[4],o=e[5],l=e[6],c=e[7],h=e[8],d=e[9],u=e[10],f=e[11],_=e[12],M=e[13],p=e[14],g=e[15],S=t*o-n*a,P=t*l-s*a,w=t*c-r*a,I=n*l-s*o,R=n*c-r*o,y=s*c-r*l,T=h*M-d*_,X=h*p-u*_,F=h*g-f*_,V=d*p-u*M,$=d*g-f*M,Q=u*g-f*p,U=S*Q-P*$+w*V+I*F-R*X+y*T;if(U===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let J=1/U;return e[0]=(o*Q-l*$+c*V)*J,e[1]=(s*$-n*Q-r*V)*J,e[2]=(M*y-p*R+g*I)*J,e[3]=(u*R-d*y-f*I)*J,e[4]=(l*F-a*Q-c*X)*J,e[5]=(t*Q-s*F+r*X)*J,e[6]=(p*w-_*y-g*P)*J,e[7]=(h*y-u*w+f*P)*J,e[8]=(a*$-o*F+c*T)*J,e[9]=(n*F-t*$-r*T)*J,e[10]=(_*R-M*w+g*S)*J,e[11]=(d*w-h*R-f*S)*J,e[12]=(o*X-a*V-l*T)*J,e[13]=(t*V-n*X+s*T)*J,e[14]=(M*P-_*I-p*S)*J,e[15]=(h*I-d*P+u*S)*J,this}scale(e){let t=this.elements,n=e.x,s=e.y,r=e.z;return t[0]*=n,t[4]*=s,t[8]*=r,t[1]*=n,t[5]*=s,t[9]*=r,t[2]*=n,t[6]*=s,t[10]*=r,t[3]*=n,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,s))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),s=Math.sin(t),r=1-n,a=e.x,o=e.y,l=e.z,c=r*a,h=r*o;return this.set(c*a+n,c*o-s*l,c*l+s*o,0,c*o+s*l,h*o+n,h*l-s*a,0,c*l-s*o,h*l+s*a,r*l*l+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,s,r,a){return this.set(1,n,r,0,e,1,a,0,t,s,1,0,0,0,0,1),this}compose(e,t,n){let s=this.elements,r=t._x,a=t._y,o=t._z,l=t._w,c=r+r,h=a+a,d=o+o,u=r*c,f=r*h,_=r*d,M=a*h,p=a*d,g=o*d,S=l*c,P=l*h,w=l*d,I=n.x,R=n.y,y=n.z;return s[0]=(1-(M+g))*I,s[1]=(f+w)*I,s[2]=(_-P)*I,s[3]=0,s[4]=(f-w)*R,s[5]=(1-(u+g))*R,s[6]=(p+S)*R,s[7]=0,s[8]=(_+P)*y,s[9]=(p-S)*y,s[10]=(1-(u+M))*y,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,n){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return n.set(1,1,1),t.identity(),this;let a=is.set(s[0],s[1],s[2]).length(),o=is.set(s[4],s[5],s[6]).length(),l=is.set(s[8],s[9],s[10]).length();r<0&&(a=-a),_n.copy(this);let c=1/a,h=1/o,d=1/l;return _n.elements[0]*=c,_n.elements[1]*=c,_n.elements[2]*=c,_n.elements[4]*=h,_n.elements[5]*=h,_n.elements[6]*=h,_n.elements[8]*=d,_n.elements[9]*=d,_n.elements[10]*=d,t.setFromRotationMatrix(_n),n.x=a,n.y=o,n.z=l,this}makePerspective(e,t,n,s,r,a,o=pn,l=!1){let c=this.elements,h=2*r/(t-e),d=2*r/(n-s),u=(t+e)/(t-e),f=(n+s)/(n-s),_,M;if(l)_=r/(a-r),M=a*r/(a-r);else if(o===pn)_=-(a+r)/(a-r),M=-2*a*r/(a-r);else if(o===ys)_=-a/(a-r),M=-a*r/(a-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+o);return c[0]=h,c[4]=0,c[8]=u,c[12]=0,c[1]=0,c[5]=d,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=_,c[14]=M,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,s,r,a,o=pn,l=!1){let c=this.elements,h=2/(t-e),d=2/(n-s),u=-(t+e)/(t-e),f=-(n+s)/(n-s),_,M;if(l)_=1/(a-r),M=a/(a-r);else if(o===pn)_=-2/(a-r),M=-(a+r)/(a-r);else if(o===ys)_=-1/(a-r),M=-r/(a-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+o);return c[0]=h,c[4]=0,c[8]=0,c[12]=u,c[1]=0,c[5]=d,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=_,c[14]=M,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let s=0;s<16;s++)if(t[s]!==n[s])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},is=new z,_n=new ut,mm=new z(0,0,0),gm=new z(1,1,1),li=new z,ha=new z,sn=new z,_u=new ut,yu=new on,jn=class i{constructor(e=0,t=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=n,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,s=this._order){return this._x=e,this._y=t,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let s=e.elements,r=s[0],a=s[4],o=s[8],l=s[1],c=s[5],h=s[9],d=s[2],u=s[6],f=s[10];switch(t){case"XYZ":this._y=Math.asin(We(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-h,f),this._z=Math.atan2(-a,r)):(this._x=Math.atan2(u,c),this._z=0);break;case"YXZ":this._x=Math.asin(-We(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-d,r),this._z=0);break;case"ZXY":this._x=Math.asin(We(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(-d,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-We(d,-1,1)),Math.abs(d)<.9999999?(this._x=Math.atan2(u,f),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-a,c));break;case"YZX":this._z=Math.asin(We(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-h,c),this._y=Math.atan2(-d,r)):(this._x=0,this._y=Math.atan2(o,f));break;case"XZY":this._z=Math.asin(-We(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(u,c),this._y=Math.atan2(o,r)):(this._x=Math.atan2(-h,f),this._y=0);break;default:Ne("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return _u.makeRotationFromQuaternion(e),this.setFromRotationMatrix(_u,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return yu.setFromEuler(this),this.setFromQuaternion(yu,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};jn.DEFAULT_ORDER="XYZ";var tr=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},_m=0,vu=new z,ss=new on,Wn=new ut,ua=new z,Hs=new z,ym=new z,vm=new on,xu=new z(1,0,0),bu=new z(0,1,0),Mu=new z(0,0,1),Su={type:"added"},xm={type:"removed"},rs={type:"childadded",child:null},Pl={type:"childremoved",child:null},Xt=class i extends bn{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:_m++}),this.uuid=Ls(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let e=new z,t=new jn,n=new on,s=new z(1,1,1);function r(){n.setFromEuler(t,!1)}function a(){t.setFromQuaternion(n,void 0,!1)}t._onChange(r),n._onChange(a),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new ut},normalMatrix:{value:new ze}}),this.matrix=new ut,this.matrixWorld=new ut,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new tr,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return ss.setFromAxisAngle(e,t),this.quaternion.multiply(ss),this}rotateOnWorldAxis(e,t){return ss.setFromAxisAngle(e,t),this.quaternion.premultiply(ss),this}rotateX(e){return this.rotateOnAxis(xu,e)}rotateY(e){return this.rotateOnAxis(bu,e)}rotateZ(e){return this.rotateOnAxis(Mu,e)}translateOnAxis(e,t){return vu.copy(e).applyQuaternion(this.quaternion),this.position.add(vu.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(xu,e)}translateY(e){return this.translateOnAxis(bu,e)}translateZ(e){return this.translateOnAxis(Mu,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(Wn.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?ua.copy(e):ua.set(e,t,n);let s=this.parent;this.updateWorldMatrix(!0,!1),Hs.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Wn.lookAt(Hs,ua,this.up):Wn.lookAt(ua,Hs,this.up),this.quaternion.setFromRotationMatrix(Wn),s&&(Wn.extractRotation(s.matrixWorld),ss.setFromRotationMatrix(Wn),this.quaternion.premultiply(ss.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(Oe("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(Su),rs.child=e,this.dispatchEvent(rs),rs.child=null):Oe("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(xm),Pl.child=e,this.dispatchEvent(Pl),Pl.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),Wn.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),Wn.multiply(e.parent.matrixWorld)),e.applyMatrix4(Wn),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(Su),rs.child=e,this.dispatchEvent(rs),rs.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,s=this.children.length;n<s;n++){let a=this.children[n].getObjectByProperty(e,t);if(a!==void 0)return a}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let s=this.children;for(let r=0,a=s.length;r<a;r++)s[r].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Hs,e,ym),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Hs,vm,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*n-r[8]*s,r[13]+=n-r[1]*t-r[5]*n-r[9]*s,r[14]+=s-r[2]*t-r[6]*n-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,s=t.length;n<s;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let r=this.children;for(let a=0,o=r.length;a<o;a++)r[a].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e=="string",n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(o=>({...o,boundingBox:o.boundingBox?o.boundingBox.toJSON():void 0,boundingSphere:o.boundingSphere?o.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(o=>({...o})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(o,l){return o[l.uuid]===void 0&&(o[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let o=this.geometry.parameters;if(o!==void 0&&o.shapes!==void 0){let l=o.shapes;if(Array.isArray(l))for(let c=0,h=l.length;c<h;c++){let d=l[c];r(e.shapes,d)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let o=[];for(let l=0,c=this.material.length;l<c;l++)o.push(r(e.materials,this.material[l]));s.material=o}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let o=0;o<this.children.length;o++)s.children.push(this.children[o].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let o=0;o<this.animations.length;o++){let l=this.animations[o];s.animations.push(r(e.animations,l))}}if(t){let o=a(e.geometries),l=a(e.materials),c=a(e.textures),h=a(e.images),d=a(e.shapes),u=a(e.skeletons),f=a(e.animations),_=a(e.nodes);o.length>0&&(n.geometries=o),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),h.length>0&&(n.images=h),d.length>0&&(n.shapes=d),u.length>0&&(n.skeletons=u),f.length>0&&(n.animations=f),_.length>0&&(n.nodes=_)}return n.object=s,n;function a(o){let l=[];for(let c in o){let h=o[c];delete h.metadata,l.push(h)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let n=0;n<e.children.length;n++){let s=e.children[n];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};Xt.DEFAULT_UP=new z(0,1,0);Xt.DEFAULT_MATRIX_AUTO_UPDATE=!0;Xt.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var xn=class extends Xt{constructor(){super(),this.isGroup=!0,this.type="Group"}},bm={type:"move"},Ms=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new xn,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new xn,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new z,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new z),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new xn,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new z,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new z,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let s=null,r=null,a=null,o=this._targetRay,l=this._grip,c=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){a=!0;for(let M of e.hand.values()){let p=t.getJointPose(M,n),g=this._getHandJoint(c,M);p!==null&&(g.matrix.fromArray(p.transform.matrix),g.matrix.decompose(g.position,g.quaternion,g.scale),g.matrixWorldNeedsUpdate=!0,g.jointRadius=p.radius),g.visible=p!==null}let h=c.joints["index-finger-tip"],d=c.joints["thumb-tip"],u=h.position.distanceTo(d.position),f=.02,_=.005;c.inputState.pinching&&u>f+_?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&u<=f-_&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:e,target:this})));o!==null&&(s=t.getPose(e.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(o.matrix.fromArray(s.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,s.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(s.linearVelocity)):o.hasLinearVelocity=!1,s.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(s.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(bm)))}return o!==null&&(o.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new xn;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},bd={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},ci={h:0,s:0,l:0},da={h:0,s:0,l:0};function Il(i,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?i+(e-i)*6*t:t<1/2?e:t<2/3?i+(e-i)*6*(2/3-t):i}var Ge=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=kt){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,Ke.colorSpaceToWorking(this,t),this}setRGB(e,t,n,s=Ke.workingColorSpace){return this.r=e,this.g=t,this.b=n,Ke.colorSpaceToWorking(this,s),this}setHSL(e,t,n,s=Ke.workingColorSpace){if(e=Ec(e,1),t=We(t,0,1),n=We(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,a=2*n-r;this.r=Il(a,r,e+1/3),this.g=Il(a,r,e),this.b=Il(a,r,e-1/3)}return Ke.colorSpaceToWorking(this,s),this}setStyle(e,t=kt){function n(r){r!==void 0&&parseFloat(r)<1&&Ne("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,a=s[1],o=s[2];switch(a){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:Ne("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],a=r.length;if(a===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(a===6)return this.setHex(parseInt(r,16),t);Ne("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=kt){let n=bd[e.toLowerCase()];return n!==void 0?this.setHex(n,t):Ne("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=Kn(e.r),this.g=Kn(e.g),this.b=Kn(e.b),this}copyLinearToSRGB(e){return this.r=ms(e.r),this.g=ms(e.g),this.b=ms(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=kt){return Ke.workingToColorSpace(Bt.copy(this),e),Math.round(We(Bt.r*255,0,255))*65536+Math.round(We(Bt.g*255,0,255))*256+Math.round(We(Bt.b*255,0,255))}getHexString(e=kt){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=Ke.workingColorSpace){Ke.workingToColorSpace(Bt.copy(this),t);let n=Bt.r,s=Bt.g,r=Bt.b,a=Math.max(n,s,r),o=Math.min(n,s,r),l,c,h=(o+a)/2;if(o===a)l=0,c=0;else{let d=a-o;switch(c=h<=.5?d/(a+o):d/(2-a-o),a){case n:l=(s-r)/d+(s<r?6:0);break;case s:l=(r-n)/d+2;break;case r:l=(n-s)/d+4;break}l/=6}return e.h=l,e.s=c,e.l=h,e}getRGB(e,t=Ke.workingColorSpace){return Ke.workingToColorSpace(Bt.copy(this),t),e.r=Bt.r,e.g=Bt.g,e.b=Bt.b,e}getStyle(e=kt){Ke.workingToColorSpace(Bt.copy(this),e);let t=Bt.r,n=Bt.g,s=Bt.b;return e!==kt?`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(e,t,n){return this.getHSL(ci),this.setHSL(ci.h+e,ci.s+t,ci.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(ci),e.getHSL(da);let n=Zs(ci.h,da.h,t),s=Zs(ci.s,da.s,t),r=Zs(ci.l,da.l,t);return this.setHSL(n,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*n+r[6]*s,this.g=r[1]*t+r[4]*n+r[7]*s,this.b=r[2]*t+r[5]*n+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Bt=new Ge;Ge.NAMES=bd;var nr=class extends Xt{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new jn,this.environmentIntensity=1,this.environmentRotation=new jn,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},yn=new z,Xn=new z,Ll=new z,qn=new z,as=new z,os=new z,wu=new z,Dl=new z,Nl=new z,Ul=new z,Fl=new gt,Ol=new gt,Bl=new gt,fi=class i{constructor(e=new z,t=new z,n=new z){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,s){s.subVectors(n,t),yn.subVectors(e,t),s.cross(yn);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,n,s,r){yn.subVectors(s,t),Xn.subVectors(n,t),Ll.subVectors(e,t);let a=yn.dot(yn),o=yn.dot(Xn),l=yn.dot(Ll),c=Xn.dot(Xn),h=Xn.dot(Ll),d=a*c-o*o;if(d===0)return r.set(0,0,0),null;let u=1/d,f=(c*l-o*h)*u,_=(a*h-o*l)*u;return r.set(1-f-_,_,f)}static containsPoint(e,t,n,s){return this.getBarycoord(e,t,n,s,qn)===null?!1:qn.x>=0&&qn.y>=0&&qn.x+qn.y<=1}static getInterpolation(e,t,n,s,r,a,o,l){return this.getBarycoord(e,t,n,s,qn)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,qn.x),l.addScaledVector(a,qn.y),l.addScaledVector(o,qn.z),l)}static getInterpolatedAttribute(e,t,n,s,r,a){return Fl.setScalar(0),Ol.setScalar(0),Bl.setScalar(0),Fl.fromBufferAttribute(e,t),Ol.fromBufferAttribute(e,n),Bl.fromBufferAttribute(e,s),a.setScalar(0),a.addScaledVector(Fl,r.x),a.addScaledVector(Ol,r.y),a.addScaledVector(Bl,r.z),a}static isFrontFacing(e,t,n,s){return yn.subVectors(n,t),Xn.subVectors(e,t),yn.cross(Xn).dot(s)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,s){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,n,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return yn.subVectors(this.c,this.b),Xn.subVectors(this.a,this.b),yn.cross(Xn).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return i.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return i.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,n,s,r){return i.getInterpolation(e,this.a,this.b,this.c,t,n,s,r)}containsPoint(e){return i.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return i.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,s=this.b,r=this.c,a,o;as.subVectors(s,n),os.subVectors(r,n),Dl.subVectors(e,n);let l=as.dot(Dl),c=os.dot(Dl);if(l<=0&&c<=0)return t.copy(n);Nl.subVectors(e,s);let h=as.dot(Nl),d=os.dot(Nl);if(h>=0&&d<=h)return t.copy(s);let u=l*d-h*c;if(u<=0&&l>=0&&h<=0&&l-h>0)return a=l/(l-h),t.copy(n).addScaledVector(as,a);Ul.subVectors(e,r);let f=as.dot(Ul),_=os.dot(Ul);if(_>=0&&f<=_)return t.copy(r);let M=f*c-l*_;if(M<=0&&c>=0&&_<=0)return o=c/(c-_),t.copy(n).addScaledVector(os,o);let p=h*_-f*d;if(p<=0&&d-h>=0&&f-_>=0)return wu.subVectors(r,s),o=(d-h)/(d-h+(f-_)),t.copy(s).addScaledVector(wu,o);let g=1/(p+M+u);return a=M*g,o=u*g,t.copy(n).addScaledVector(as,a).addScaledVector(os,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},Pn=class{constructor(e=new z(1/0,1/0,1/0),t=new z(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(vn.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(vn.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=vn.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let a=0,o=r.count;a<o;a++)e.isMesh===!0?e.getVertexPosition(a,vn):vn.fromBufferAttribute(r,a),vn.applyMatrix4(e.matrixWorld),this.expandByPoint(vn);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),fa.copy(e.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),fa.copy(n.boundingBox)),fa.applyMatrix4(e.matrixWorld),this.union(fa)}let s=e.children;for(let r=0,a=s.length;r<a;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,vn),vn.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(Ws),pa.subVectors(this.max,Ws),ls.subVectors(e.a,Ws),cs.subVectors(e.b,Ws),hs.subVectors(e.c,Ws),hi.subVectors(cs,ls),ui.subVectors(hs,cs),Ii.subVectors(ls,hs);let t=[0,-hi.z,hi.y,0,-ui.z,ui.y,0,-Ii.z,Ii.y,hi.z,0,-hi.x,ui.z,0,-ui.x,Ii.z,0,-Ii.x,-hi.y,hi.x,0,-ui.y,ui.x,0,-Ii.y,Ii.x,0];return!kl(t,ls,cs,hs,pa)||(t=[1,0,0,0,1,0,0,0,1],!kl(t,ls,cs,hs,pa))?!1:(ma.crossVectors(hi,ui),t=[ma.x,ma.y,ma.z],kl(t,ls,cs,hs,pa))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,vn).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(vn).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(Yn[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Yn[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Yn[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Yn[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Yn[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Yn[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Yn[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Yn[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Yn),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Yn=[new z,new z,new z,new z,new z,new z,new z,new z],vn=new z,fa=new Pn,ls=new z,cs=new z,hs=new z,hi=new z,ui=new z,Ii=new z,Ws=new z,pa=new z,ma=new z,Li=new z;function kl(i,e,t,n,s){for(let r=0,a=i.length-3;r<=a;r+=3){Li.fromArray(i,r);let o=s.x*Math.abs(Li.x)+s.y*Math.abs(Li.y)+s.z*Math.abs(Li.z),l=e.dot(Li),c=t.dot(Li),h=n.dot(Li);if(Math.max(-Math.max(l,c,h),Math.min(l,c,h))>o)return!1}return!0}var Zn=Mm();function Mm(){let i=new ArrayBuffer(4),e=new Float32Array(i),t=new Uint32Array(i),n=new Uint32Array(512),s=new Uint32Array(512);for(let l=0;l<256;++l){let c=l-127;c<-27?(n[l]=0,n[l|256]=32768,s[l]=24,s[l|256]=24):c<-14?(n[l]=1024>>-c-14,n[l|256]=1024>>-c-14|32768,s[l]=-c-1,s[l|256]=-c-1):c<=15?(n[l]=c+15<<10,n[l|256]=c+15<<10|32768,s[l]=13,s[l|256]=13):c<128?(n[l]=31744,n[l|256]=64512,s[l]=24,s[l|256]=24):(n[l]=31744,n[l|256]=64512,s[l]=13,s[l|256]=13)}let r=new Uint32Array(2048),a=new Uint32Array(64),o=new Uint32Array(64);for(let l=1;l<1024;++l){let c=l<<13,h=0;for(;(c&8388608)===0;)c<<=1,h-=8388608;c&=-8388609,h+=947912704,r[l]=c|h}for(let l=1024;l<2048;++l)r[l]=939524096+(l-1024<<13);for(let l=1;l<31;++l)a[l]=l<<23;a[31]=1199570944,a[32]=2147483648;for(let l=33;l<63;++l)a[l]=2147483648+(l-32<<23);a[63]=3347054592;for(let l=1;l<64;++l)l!==32&&(o[l]=1024);return{floatView:e,uint32View:t,baseTable:n,shiftTable:s,mantissaTable:r,exponentTable:a,offsetTable:o}}function Sm(i){Math.abs(i)>65504&&Ne("DataUtils.toHalfFloat(): Value out of range."),i=We(i,-65504,65504),Zn.floatView[0]=i;let e=Zn.uint32View[0],t=e>>23&511;return Zn.baseTable[t]+((e&8388607)>>Zn.shiftTable[t])}function wm(i){let e=i>>10;return Zn.uint32View[0]=Zn.mantissaTable[Zn.offsetTable[e]+(i&1023)]+Zn.exponentTable[e],Zn.floatView[0]}var ir=class{static toHalfFloat(e){return Sm(e)}static fromHalfFloat(e){return wm(e)}},St=new z,ga=new Be,Em=0,bt=class extends bn{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Em++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=n,this.usage=pd,this.updateRanges=[],this.gpuType=Sn,this.version=0,this._normalizationScale=e!==void 0?Tc(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[n+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)ga.fromBufferAttribute(this,t),ga.applyMatrix3(e),this.setXY(t,ga.x,ga.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)St.fromBufferAttribute(this,t),St.applyMatrix3(e),this.setXYZ(t,St.x,St.y,St.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)St.fromBufferAttribute(this,t),St.applyMatrix4(e),this.setXYZ(t,St.x,St.y,St.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)St.fromBufferAttribute(this,t),St.applyNormalMatrix(e),this.setXYZ(t,St.x,St.y,St.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)St.fromBufferAttribute(this,t),St.transformDirection(e),this.setXYZ(t,St.x,St.y,St.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this}setXYZW(e,t,n,s,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),s=this._normalize(s),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):vd(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):xd(e,this.array)}};var sr=class extends bt{constructor(e,t,n){super(new Uint16Array(e),t,n)}};var rr=class extends bt{constructor(e,t,n){super(new Uint32Array(e),t,n)}};var mn=class extends bt{constructor(e,t,n){super(new Float32Array(e),t,n)}},Am=new Pn,Xs=new z,zl=new z,pi=class{constructor(e=new z,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t!==void 0?n.copy(t):Am.setFromPoints(e).getCenter(n);let s=0;for(let r=0,a=e.length;r<a;r++)s=Math.max(s,n.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;Xs.subVectors(e,this.center);let t=Xs.lengthSq();if(t>this.radius*this.radius){let n=Math.sqrt(t),s=(n-this.radius)*.5;this.center.addScaledVector(Xs,s/n),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(zl.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(Xs.copy(e.center).add(zl)),this.expandByPoint(Xs.copy(e.center).sub(zl))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},Tm=0,fn=new ut,Vl=new Xt,us=new z,rn=new Pn,qs=new Pn,Pt=new z,In=class i extends bn{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Tm++}),this.uuid=Ls(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(Zp(e)?rr:sr)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new ze().getNormalMatrix(e);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return fn.makeRotationFromQuaternion(e),this.applyMatrix4(fn),this}rotateX(e){return fn.makeRotationX(e),this.applyMatrix4(fn),this}rotateY(e){return fn.makeRotationY(e),this.applyMatrix4(fn),this}rotateZ(e){return fn.makeRotationZ(e),this.applyMatrix4(fn),this}translate(e,t,n){return fn.makeTranslation(e,t,n),this.applyMatrix4(fn),this}scale(e,t,n){return fn.makeScale(e,t,n),this.applyMatrix4(fn),this}lookAt(e){return Vl.lookAt(e),Vl.updateMatrix(),this.applyMatrix4(Vl.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(us).negate(),this.translate(us.x,us.y,us.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let n=[];for(let s=0,r=e.length;s<r;s++){let a=e[s];n.push(a.x,a.y,a.z||0)}this.setAttribute("position",new mn(n,3))}else{let n=Math.min(e.length,t.count);for(let s=0;s<n;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&Ne("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new Pn);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Oe("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new z(-1/0,-1/0,-1/0),new z(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let n=0,s=t.length;n<s;n++){let r=t[n];rn.setFromBufferAttribute(r),this.morphTargetsRelative?(Pt.addVectors(this.boundingBox.min,rn.min),this.boundingBox.expandByPoint(Pt),Pt.addVectors(this.boundingBox.max,rn.max),this.boundingBox.expandByPoint(Pt)):(this.boundingBox.expandByPoint(rn.min),this.boundingBox.expandByPoint(rn.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Oe('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new pi);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Oe("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new z,1/0);return}if(e){let n=this.boundingSphere.center;if(rn.setFromBufferAttribute(e),t)for(let r=0,a=t.length;r<a;r++){let o=t[r];qs.setFromBufferAttribute(o),this.morphTargetsRelative?(Pt.addVectors(rn.min,qs.min),rn.expandByPoint(Pt),Pt.addVectors(rn.max,qs.max),rn.expandByPoint(Pt)):(rn.expandByPoint(qs.min),rn.expandByPoint(qs.max))}rn.getCenter(n);let s=0;for(let r=0,a=e.count;r<a;r++)Pt.fromBufferAttribute(e,r),s=Math.max(s,n.distanceToSquared(Pt));if(t)for(let r=0,a=t.length;r<a;r++){let o=t[r],l=this.morphTargetsRelative;for(let c=0,h=o.count;c<h;c++)Pt.fromBufferAttribute(o,c),l&&(us.fromBufferAttribute(e,c),Pt.add(us)),s=Math.max(s,n.distanceToSquared(Pt))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Oe('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Oe("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=t.position,s=t.normal,r=t.uv,a=this.getAttribute("tangent");(a===void 0||a.count!==n.count)&&(a=new bt(new Float32Array(4*n.count),4),this.setAttribute("tangent",a));let o=[],l=[],c=new Uint8Array(n.count);for(let X=0;X<n.count;X++)o[X]=new z,l[X]=new z;let h=new z,d=new z,u=new z,f=new Be,_=new Be,M=new Be,p=new z,g=new z;function S(X,F,V){c[X]=c[F]=c[V]=1,h.fromBufferAttribute(n,X),d.fromBufferAttribute(n,F),u.fromBufferAttribute(n,V),f.fromBufferAttribute(r,X),_.fromBufferAttribute(r,F),M.fromBufferAttribute(r,V),d.sub(h),u.sub(h),_.sub(f),M.sub(f);let $=1/(_.x*M.y-M.x*_.y);isFinite($)&&(p.copy(d).multiplyScalar(M.y).addScaledVector(u,-_.y).multiplyScalar($),g.copy(u).multiplyScalar(_.x).addScaledVector(d,-M.x).multiplyScalar($),o[X].add(p),o[F].add(p),o[V].add(p),l[X].add(g),l[F].add(g),l[V].add(g))}let P=this.groups;P.length===0&&(P=[{start:0,count:e.count}]);for(let X=0,F=P.length;X<F;++X){let V=P[X],$=V.start,Q=V.count;for(let U=$,J=$+Q;U<J;U+=3)S(e.getX(U+0),e.getX(U+1),e.getX(U+2))}let w=new z,I=new z,R=new z,y=new z;function T(X){R.fromBufferAttribute(s,X),y.copy(R);let F=o[X];w.copy(F),w.sub(R.multiplyScalar(R.dot(F))).normalize(),I.crossVectors(y,F);let $=I.dot(l[X])<0?-1:1;a.setXYZW(X,w.x,w.y,w.z,$)}for(let X=0,F=n.count;X<F;++X)c[X]&&T(X);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let n=this.getAttribute("normal");if(n===void 0||n.count!==t.count)n=new bt(new Float32Array(t.count*3),3),this.setAttribute("normal",n);else for(let u=0,f=n.count;u<f;u++)n.setXYZ(u,0,0,0);let s=new z,r=new z,a=new z,o=new z,l=new z,c=new z,h=new z,d=new z;if(e)for(let u=0,f=e.count;u<f;u+=3){let _=e.getX(u+0),M=e.getX(u+1),p=e.getX(u+2);s.fromBufferAttribute(t,_),r.fromBufferAttribute(t,M),a.fromBufferAttribute(t,p),h.subVectors(a,r),d.subVectors(s,r),h.cross(d),o.fromBufferAttribute(n,_),l.fromBufferAttribute(n,M),c.fromBufferAttribute(n,p),o.add(h),l.add(h),c.add(h),n.setXYZ(_,o.x,o.y,o.z),n.setXYZ(M,l.x,l.y,l.z),n.setXYZ(p,c.x,c.y,c.z)}else for(let u=0,f=t.count;u<f;u+=3)s.fromBufferAttribute(t,u+0),r.fromBufferAttribute(t,u+1),a.fromBufferAttribute(t,u+2),h.subVectors(a,r),d.subVectors(s,r),h.cross(d),n.setXYZ(u+0,h.x,h.y,h.z),n.setXYZ(u+1,h.x,h.y,h.z),n.setXYZ(u+2,h.x,h.y,h.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)Pt.fromBufferAttribute(e,t),Pt.normalize(),e.setXYZ(t,Pt.x,Pt.y,Pt.z)}toNonIndexed(){function e(o,l){let c=o.array,h=o.itemSize,d=o.normalized,u=new c.constructor(l.length*h),f=0,_=0;for(let M=0,p=l.length;M<p;M++){o.isInterleavedBufferAttribute?f=l[M]*o.data.stride+o.offset:f=l[M]*h;for(let g=0;g<h;g++)u[_++]=c[f++]}return new bt(u,h,d)}if(this.index===null)return Ne("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new i,n=this.index.array,s=this.attributes;for(let o in s){let l=s[o],c=e(l,n);t.setAttribute(o,c)}let r=this.morphAttributes;for(let o in r){let l=[],c=r[o];for(let h=0,d=c.length;h<d;h++){let u=c[h],f=e(u,n);l.push(f)}t.morphAttributes[o]=l}t.morphTargetsRelative=this.morphTargetsRelative;let a=this.groups;for(let o=0,l=a.length;o<l;o++){let c=a[o];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let l in n){let c=n[l];e.data.attributes[l]=c.toJSON(e.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],h=[];for(let d=0,u=c.length;d<u;d++){let f=c[d];h.push(f.toJSON(e.data))}h.length>0&&(s[l]=h,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let s=e.attributes;for(let c in s){let h=s[c];this.setAttribute(c,h.clone(t))}let r=e.morphAttributes;for(let c in r){let h=[],d=r[c];for(let u=0,f=d.length;u<f;u++)h.push(d[u].clone(t));this.morphAttributes[c]=h}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let c=0,h=a.length;c<h;c++){let d=a[c];this.addGroup(d.start,d.count,d.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var Gl=new z,Rm=new z,Cm=new ze,an=class{constructor(e=new z(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,s){return this.normal.set(e,t,n),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let s=Gl.subVectors(n,t).cross(Rm.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let s=e.delta(Gl),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/r;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(s,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||Cm.getNormalMatrix(e),s=this.coplanarPoint(Gl).applyMatrix4(e),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},Pm=0,mi=class extends bn{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Pm++}),this.uuid=Ls(),this.name="",this.type="Material",this.blending=Rs,this.side=Nn,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=ic,this.blendDst=sc,this.blendEquation=zi,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Ge(0,0,0),this.blendAlpha=0,this.depthFunc=gs,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=ld,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=Ia,this.stencilZFail=Ia,this.stencilZPass=Ia,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){Ne(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Ne(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector2&&n&&n.isVector2||s&&s.isEuler&&n&&n.isEuler||s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let a=[];for(let o in r){let l=r[o];delete l.metadata,a.push(l)}return a}if(t){let r=s(e.textures),a=s(e.images);r.length>0&&(n.textures=r),a.length>0&&(n.images=a)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new Ge().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(n=>new an().fromJSON(n))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let n=e.normalScale;Array.isArray(n)===!1&&(n=[n,n]),this.normalScale=new Be().fromArray(n)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Be().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let s=t.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var $n=new z,Hl=new z,_a=new z,ya=new z,Ss=class{constructor(e=new z,t=new z(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,$n)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=$n.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):($n.copy(this.origin).addScaledVector(this.direction,t),$n.distanceToSquared(e))}distanceSqToSegment(e,t,n,s){Hl.copy(e).add(t).multiplyScalar(.5),_a.copy(t).sub(e).normalize(),ya.copy(this.origin).sub(Hl);let r=e.distanceTo(t)*.5,a=-this.direction.dot(_a),o=ya.dot(this.direction),l=-ya.dot(_a),c=ya.lengthSq(),h=Math.abs(1-a*a),d,u,f,_;if(h>0)if(d=a*l-o,u=a*o-l,_=r*h,d>=0)if(u>=-_)if(u<=_){let M=1/h;d*=M,u*=M,f=d*(d+a*u+2*o)+u*(a*d+u+2*l)+c}else u=r,d=Math.max(0,-(a*u+o)),f=-d*d+u*(u+2*l)+c;else u=-r,d=Math.max(0,-(a*u+o)),f=-d*d+u*(u+2*l)+c;else u<=-_?(d=Math.max(0,-(-a*r+o)),u=d>0?-r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c):u<=_?(d=0,u=Math.min(Math.max(-r,-l),r),f=u*(u+2*l)+c):(d=Math.max(0,-(a*r+o)),u=d>0?r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c);else u=a>0?-r:r,d=Math.max(0,-(a*u+o)),f=-d*d+u*(u+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,d),s&&s.copy(Hl).addScaledVector(_a,u),f}intersectSphere(e,t){if(e.radius<0)return null;$n.subVectors(e.center,this.origin);let n=$n.dot(this.direction),s=$n.dot($n)-n*n,r=e.radius*e.radius;if(s>r)return null;let a=Math.sqrt(r-s),o=n-a,l=n+a;return l<0?null:o<0?this.at(l,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,s,r,a,o,l,c=1/this.direction.x,h=1/this.direction.y,d=1/this.direction.z,u=this.origin;return c>=0?(n=(e.min.x-u.x)*c,s=(e.max.x-u.x)*c):(n=(e.max.x-u.x)*c,s=(e.min.x-u.x)*c),h>=0?(r=(e.min.y-u.y)*h,a=(e.max.y-u.y)*h):(r=(e.max.y-u.y)*h,a=(e.min.y-u.y)*h),n>a||r>s||((r>n||isNaN(n))&&(n=r),(a<s||isNaN(s))&&(s=a),d>=0?(o=(e.min.z-u.z)*d,l=(e.max.z-u.z)*d):(o=(e.max.z-u.z)*d,l=(e.min.z-u.z)*d),n>l||o>s)||((o>n||n!==n)&&(n=o),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,t)}intersectsBox(e){return this.intersectBox(e,$n)!==null}intersectTriangle(e,t,n,s,r){let a=this.origin,o=this.direction,l=o.x,c=o.y,h=o.z,d=e.x-a.x,u=e.y-a.y,f=e.z-a.z,_=t.x-a.x,M=t.y-a.y,p=t.z-a.z,g=n.x-a.x,S=n.y-a.y,P=n.z-a.z,w=Math.abs(l),I=Math.abs(c),R=Math.abs(h),y,T,X,F,V,$,Q,U,J,se,Z,he;if(w>=I&&w>=R?(X=l,$=d,J=_,he=g,l>=0?(y=c,T=h,F=u,V=f,Q=M,U=p,se=S,Z=P):(y=h,T=c,F=f,V=u,Q=p,U=M,se=P,Z=S)):I>=R?(X=c,$=u,J=M,he=S,c>=0?(y=h,T=l,F=f,V=d,Q=p,U=_,se=P,Z=g):(y=l,T=h,F=d,V=f,Q=_,U=p,se=g,Z=P)):(X=h,$=f,J=p,he=P,h>=0?(y=l,T=c,F=d,V=u,Q=_,U=M,se=g,Z=S):(y=c,T=l,F=u,V=d,Q=M,U=_,se=S,Z=g)),X===0)return null;let K=y/X,oe=T/X,le=1/X,Re=F-K*$,ke=V-oe*$,ne=Q-K*J,ve=U-oe*J,Me=se-K*he,Pe=Z-oe*he,_e=Me*ve-Pe*ne,Ue=Re*Pe-ke*Me,dt=ne*ke-ve*Re;if(s){if(_e<0||Ue<0||dt<0)return null}else if((_e<0||Ue<0||dt<0)&&(_e>0||Ue>0||dt>0))return null;let De=_e+Ue+dt;if(De===0)return null;let je=le*(_e*$+Ue*J+dt*he);return(De>0?je<0:je>0)?null:this.at(je/De,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Ui=class extends mi{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new Ge(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new jn,this.combine=rc,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},Eu=new ut,Di=new Ss,va=new pi,Au=new z,xa=new z,ba=new z,Ma=new z,Wl=new z,Sa=new z,Tu=new z,wa=new z,qt=class extends Xt{constructor(e=new In,t=new Ui){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,n=Object.keys(t);if(n.length>0){let s=t[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,a=s.length;r<a;r++){let o=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[o]=r}}}}getVertexPosition(e,t){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(s,e);let o=this.morphTargetInfluences;if(r&&o){Sa.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let h=o[l],d=r[l];h!==0&&(Wl.fromBufferAttribute(d,e),a?Sa.addScaledVector(Wl,h):Sa.addScaledVector(Wl.sub(t),h))}t.add(Sa)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),va.copy(n.boundingSphere),va.applyMatrix4(r),Di.copy(e.ray).recast(e.near),!(va.containsPoint(Di.origin)===!1&&(Di.intersectSphere(va,Au)===null||Di.origin.distanceToSquared(Au)>(e.far-e.near)**2))&&(Eu.copy(r).invert(),Di.copy(e.ray).applyMatrix4(Eu),!(n.boundingBox!==null&&Di.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(e,t,Di)))}_computeIntersections(e,t,n){let s,r=this.geometry,a=this.material,o=r.index,l=r.attributes.position,c=r.attributes.uv,h=r.attributes.uv1,d=r.attributes.normal,u=r.groups,f=r.drawRange;if(o!==null)if(Array.isArray(a))for(let _=0,M=u.length;_<M;_++){let p=u[_],g=a[p.materialIndex],S=Math.max(p.start,f.start),P=Math.min(o.count,Math.min(p.start+p.count,f.start+f.count));for(let w=S,I=P;w<I;w+=3){let R=o.getX(w),y=o.getX(w+1),T=o.getX(w+2);s=Ea(this,g,e,n,c,h,d,R,y,T),s&&(s.faceIndex=Math.floor(w/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let _=Math.max(0,f.start),M=Math.min(o.count,f.start+f.count);for(let p=_,g=M;p<g;p+=3){let S=o.getX(p),P=o.getX(p+1),w=o.getX(p+2);s=Ea(this,a,e,n,c,h,d,S,P,w),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(a))for(let _=0,M=u.length;_<M;_++){let p=u[_],g=a[p.materialIndex],S=Math.max(p.start,f.start),P=Math.min(l.count,Math.min(p.start+p.count,f.start+f.count));for(let w=S,I=P;w<I;w+=3){let R=w,y=w+1,T=w+2;s=Ea(this,g,e,n,c,h,d,R,y,T),s&&(s.faceIndex=Math.floor(w/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let _=Math.max(0,f.start),M=Math.min(l.count,f.start+f.count);for(let p=_,g=M;p<g;p+=3){let S=p,P=p+1,w=p+2;s=Ea(this,a,e,n,c,h,d,S,P,w),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}}};function Im(i,e,t,n,s,r,a,o){let l;if(e.side===Yt?l=n.intersectTriangle(a,r,s,!0,o):l=n.intersectTriangle(s,r,a,e.side===Nn,o),l===null)return null;wa.copy(o),wa.applyMatrix4(i.matrixWorld);let c=t.ray.origin.distanceTo(wa);return c<t.near||c>t.far?null:{distance:c,point:wa.clone(),object:i}}function Ea(i,e,t,n,s,r,a,o,l,c){i.getVertexPosition(o,xa),i.getVertexPosition(l,ba),i.getVertexPosition(c,Ma);let h=Im(i,e,t,n,xa,ba,Ma,Tu);if(h){let d=new z;fi.getBarycoord(Tu,xa,ba,Ma,d),s&&(h.uv=fi.getInterpolatedAttribute(s,o,l,c,d,new Be)),r&&(h.uv1=fi.getInterpolatedAttribute(r,o,l,c,d,new Be)),a&&(h.normal=fi.getInterpolatedAttribute(a,o,l,c,d,new z),h.normal.dot(n.direction)>0&&h.normal.multiplyScalar(-1));let u={a:o,b:l,c,normal:new z,materialIndex:0};fi.getNormal(xa,ba,Ma,u.normal),h.face=u,h.barycoord=d}return h}var Fi=class extends zt{constructor(e=null,t=1,n=1,s,r,a,o,l,c=It,h=It,d,u){super(null,a,o,l,c,h,s,r,d,u),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var Ni=new pi,Lm=new Be(.5,.5),Aa=new z,gi=class{constructor(e=new an,t=new an,n=new an,s=new an,r=new an,a=new an){this.planes=[e,t,n,s,r,a]}set(e,t,n,s,r,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(s),o[4].copy(r),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=pn,n=!1){let s=this.planes,r=e.elements,a=r[0],o=r[1],l=r[2],c=r[3],h=r[4],d=r[5],u=r[6],f=r[7],_=r[8],M=r[9],p=r[10],g=r[11],S=r[12],P=r[13],w=r[14],I=r[15];if(s[0].setComponents(c-a,f-h,g-_,I-S).normalize(),s[1].setComponents(c+a,f+h,g+_,I+S).normalize(),s[2].setComponents(c+o,f+d,g+M,I+P).normalize(),s[3].setComponents(c-o,f-d,g-M,I-P).normalize(),n)s[4].setComponents(l,u,p,w).normalize(),s[5].setComponents(c-l,f-u,g-p,I-w).normalize();else if(s[4].setComponents(c-l,f-u,g-p,I-w).normalize(),t===pn)s[5].setComponents(c+l,f+u,g+p,I+w).normalize();else if(t===ys)s[5].setComponents(l,u,p,w).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Ni.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Ni.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Ni)}intersectsSprite(e){Ni.center.set(0,0,0);let t=Lm.distanceTo(e.center);return Ni.radius=.7071067811865476+t,Ni.applyMatrix4(e.matrixWorld),this.intersectsSphere(Ni)}intersectsSphere(e){let t=this.planes,n=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let s=t[n];if(Aa.x=s.normal.x>0?e.max.x:e.min.x,Aa.y=s.normal.y>0?e.max.y:e.min.y,Aa.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(Aa)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},Ru=new ut,Wa=class i{constructor(){this.coordinateSystem=pn,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let s=0;s<t.length;s++){let r=t[s];Ru.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[s]===void 0&&(n[s]=new gi),n[s].setFromProjectionMatrix(Ru,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new gi),t[s].copy(n[s]);return this._count=e._count,this}clone(){return new i().copy(this)}};var ar=class extends zt{constructor(e=[],t=Vi,n,s,r,a,o,l,c,h){super(e,t,n,s,r,a,o,l,c,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var Qn=class extends zt{constructor(e,t,n=Mn,s,r,a,o=It,l=It,c,h=Jn,d=1){if(h!==Jn&&h!==ti)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let u={width:e,height:t,depth:d};super(u,s,r,a,o,l,h,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new bs(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},or=class extends Qn{constructor(e,t=Mn,n=Vi,s,r,a=It,o=It,l,c=Jn){let h={width:e,height:e,depth:1},d=[h,h,h,h,h,h];super(e,e,t,n,s,r,a,o,l,c),this.image=d,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},lr=class extends zt{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},ws=class i extends In{constructor(e=1,t=1,n=1,s=1,r=1,a=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:n,widthSegments:s,heightSegments:r,depthSegments:a};let o=this;s=Math.floor(s),r=Math.floor(r),a=Math.floor(a);let l=[],c=[],h=[],d=[],u=0,f=0;_("z","y","x",-1,-1,n,t,e,a,r,0),_("z","y","x",1,-1,n,t,-e,a,r,1),_("x","z","y",1,1,e,n,t,s,a,2),_("x","z","y",1,-1,e,n,-t,s,a,3),_("x","y","z",1,-1,e,t,n,s,r,4),_("x","y","z",-1,-1,e,t,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new mn(c,3)),this.setAttribute("normal",new mn(h,3)),this.setAttribute("uv",new mn(d,2));function _(M,p,g,S,P,w,I,R,y,T,X){let F=w/y,V=I/T,$=w/2,Q=I/2,U=R/2,J=y+1,se=T+1,Z=0,he=0,K=new z;for(let oe=0;oe<se;oe++){let le=oe*V-Q;for(let Re=0;Re<J;Re++){let ke=Re*F-$;K[M]=ke*S,K[p]=le*P,K[g]=U,c.push(K.x,K.y,K.z),K[M]=0,K[p]=0,K[g]=R>0?1:-1,h.push(K.x,K.y,K.z),d.push(Re/y),d.push(1-oe/T),Z+=1}}for(let oe=0;oe<T;oe++)for(let le=0;le<y;le++){let Re=u+le+J*oe,ke=u+le+J*(oe+1),ne=u+(le+1)+J*(oe+1),ve=u+(le+1)+J*oe;l.push(Re,ke,ve),l.push(ke,ne,ve),he+=6}o.addGroup(f,he,X),f+=he,u+=Z}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var Oi=class i extends In{constructor(e=1,t=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:n,heightSegments:s};let r=e/2,a=t/2,o=Math.floor(n),l=Math.floor(s),c=o+1,h=l+1,d=e/o,u=t/l,f=[],_=[],M=[],p=[];for(let g=0;g<h;g++){let S=g*u-a;for(let P=0;P<c;P++){let w=P*d-r;_.push(w,-S,0),M.push(0,0,1),p.push(P/o),p.push(1-g/l)}}for(let g=0;g<l;g++)for(let S=0;S<o;S++){let P=S+c*g,w=S+c*(g+1),I=S+1+c*(g+1),R=S+1+c*g;f.push(P,w,R),f.push(w,I,R)}this.setIndex(f),this.setAttribute("position",new mn(_,3)),this.setAttribute("normal",new mn(M,3)),this.setAttribute("uv",new mn(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new i(e.width,e.height,e.widthSegments,e.heightSegments)}};function Hi(i){let e={};for(let t in i){e[t]={};for(let n in i[t]){let s=i[t][n];if(Cu(s))s.isRenderTargetTexture?(Ne("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][n]=null):e[t][n]=s.clone();else if(Array.isArray(s))if(Cu(s[0])){let r=[];for(let a=0,o=s.length;a<o;a++)r[a]=s[a].clone();e[t][n]=r}else e[t][n]=s.slice();else e[t][n]=s}}return e}function Vt(i){let e={};for(let t=0;t<i.length;t++){let n=Hi(i[t]);for(let s in n)e[s]=n[s]}return e}function Cu(i){return i&&(i.isColor||i.isMatrix3||i.isMatrix4||i.isVector2||i.isVector3||i.isVector4||i.isTexture||i.isQuaternion)}function Dm(i){let e=[];for(let t=0;t<i.length;t++)e.push(i[t].clone());return e}function Rc(i){let e=i.getRenderTarget();return e===null?i.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:Ke.workingColorSpace}var Md={clone:Hi,merge:Vt},Nm=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Um=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Ln=class extends mi{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Nm,this.fragmentShader=Um,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Hi(e.uniforms),this.uniformsGroups=Dm(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let a=this.uniforms[s].value;a&&a.isTexture?t.uniforms[s]={type:"t",value:a.toJSON(e).uuid}:a&&a.isColor?t.uniforms[s]={type:"c",value:a.getHex()}:a&&a.isVector2?t.uniforms[s]={type:"v2",value:a.toArray()}:a&&a.isVector3?t.uniforms[s]={type:"v3",value:a.toArray()}:a&&a.isVector4?t.uniforms[s]={type:"v4",value:a.toArray()}:a&&a.isMatrix3?t.uniforms[s]={type:"m3",value:a.toArray()}:a&&a.isMatrix4?t.uniforms[s]={type:"m4",value:a.toArray()}:t.uniforms[s]={value:a}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let s=e.uniforms[n];switch(this.uniforms[n]={},s.type){case"t":this.uniforms[n].value=t[s.value]||null;break;case"c":this.uniforms[n].value=new Ge().setHex(s.value);break;case"v2":this.uniforms[n].value=new Be().fromArray(s.value);break;case"v3":this.uniforms[n].value=new z().fromArray(s.value);break;case"v4":this.uniforms[n].value=new gt().fromArray(s.value);break;case"m3":this.uniforms[n].value=new ze().fromArray(s.value);break;case"m4":this.uniforms[n].value=new ut().fromArray(s.value);break;default:this.uniforms[n].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let n in e.extensions)this.extensions[n]=e.extensions[n];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},Xa=class extends Ln{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}},Bi=class extends mi{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type="MeshStandardMaterial",this.defines={STANDARD:""},this.color=new Ge(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new Ge(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Xo,this.normalScale=new Be(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new jn,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:""},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}};var qa=class extends mi{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=ad,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Ya=class extends mi{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function ds(i,e){return!i||i.constructor===e?i:typeof e.BYTES_PER_ELEMENT=="number"?new e(i):Array.prototype.slice.call(i)}function Ta(i){return i!==void 0&&i.inTangents!==void 0&&i.outTangents!==void 0}var _i=class{constructor(e,t,n,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(n),this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,s=t[n],r=t[n-1];n:{e:{let a;t:{i:if(!(e<s)){for(let o=n+2;;){if(s===void 0){if(e<r)break i;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===o)break;if(r=s,s=t[++n],e<s)break e}a=t.length;break t}if(!(e>=r)){let o=t[1];e<o&&(n=2,r=o);for(let l=n-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===l)break;if(s=r,r=t[--n-1],e>=r)break e}a=n,n=0;break t}break n}for(;n<a;){let o=n+a>>>1;e<t[o]?a=o:n=o+1}if(s=t[n],r=t[n-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=e*s;for(let a=0;a!==s;++a)t[a]=n[r+a];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},$a=class extends _i{constructor(e,t,n,s){super(e,t,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:Yl,endingEnd:Yl}}intervalChanged_(e,t,n){let s=this.parameterPositions,r=e-2,a=e+1,o=s[r],l=s[a];if(o===void 0)switch(this.getSettings_().endingStart){case $l:r=e,o=2*t-n;break;case Zl:r=s.length-2,o=t+s[r]-s[r+1];break;default:r=e,o=n}if(l===void 0)switch(this.getSettings_().endingEnd){case $l:a=e,l=2*n-t;break;case Zl:a=1,l=n+s[1]-s[0];break;default:a=e-1,l=t}let c=(n-t)*.5,h=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(l-n),this._offsetPrev=r*h,this._offsetNext=a*h}interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=e*o,c=l-o,h=this._offsetPrev,d=this._offsetNext,u=this._weightPrev,f=this._weightNext,_=(n-t)/(s-t),M=_*_,p=M*_,g=-u*p+2*u*M-u*_,S=(1+u)*p+(-1.5-2*u)*M+(-.5+u)*_+1,P=(-1-f)*p+(1.5+f)*M+.5*_,w=f*p-f*M;for(let I=0;I!==o;++I)r[I]=g*a[h+I]+S*a[c+I]+P*a[l+I]+w*a[d+I];return r}},Za=class extends _i{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=e*o,c=l-o,h=(n-t)/(s-t),d=1-h;for(let u=0;u!==o;++u)r[u]=a[c+u]*d+a[l+u]*h;return r}},Ka=class extends _i{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e){return this.copySampleValue_(e-1)}},Ja=class extends _i{interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=e*o,c=l-o,h=this.inTangents,d=this.outTangents;if(!h||!d){let _=(n-t)/(s-t),M=1-_;for(let p=0;p!==o;++p)r[p]=a[c+p]*M+a[l+p]*_;return r}let u=o*2,f=e-1;for(let _=0;_!==o;++_){let M=a[c+_],p=a[l+_],g=f*u+_*2,S=d[g],P=d[g+1],w=e*u+_*2,I=h[w],R=h[w+1],y=Om(n,t,S,I,s);r[_]=Sd(y,M,P,R,p)}return r}};function Sd(i,e,t,n,s){let r=1-i;return r*r*r*e+3*r*r*i*t+3*r*i*i*n+i*i*i*s}function Fm(i,e,t,n,s){let r=1-i;return 3*r*r*(t-e)+6*r*i*(n-t)+3*i*i*(s-n)}function Om(i,e,t,n,s){let r=(i-e)/(s-e);for(let a=0;a<8;a++){let o=Sd(r,e,t,n,s)-i;if(Math.abs(o)<1e-10)break;let l=Fm(r,e,t,n,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-o/l))}return r}var cn=class{constructor(e,t,n,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=ds(t,this.TimeBufferType),this.values=ds(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:ds(e.times,Array),values:ds(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(n.interpolation=s),Ta(e.settings)&&(n.settings={inTangents:ds(e.settings.inTangents,Array),outTangents:ds(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new Ka(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new Za(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new $a(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new Ja(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case Ks:t=this.InterpolantFactoryMethodDiscrete;break;case za:t=this.InterpolantFactoryMethodLinear;break;case Pa:t=this.InterpolantFactoryMethodSmooth;break;case ql:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return Ne("KeyframeTrack:",n),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Ks;case this.InterpolantFactoryMethodLinear:return za;case this.InterpolantFactoryMethodSmooth:return Pa;case this.InterpolantFactoryMethodBezier:return ql}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]+=e;Ta(this.settings)&&(Pu(this.settings.inTangents,e),Pu(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,s=t.length;n!==s;++n)t[n]*=e;Ta(this.settings)&&(Iu(this.settings.inTangents,e),Iu(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,s=n.length,r=0,a=s-1;for(;r!==s&&n[r]<e;)++r;for(;a!==-1&&n[a]>t;)--a;if(++a,r!==0||a!==s){r>=a&&(a=Math.max(a,1),r=a-1);let o=this.getValueSize();this.times=n.slice(r,a),this.values=this.values.slice(r*o,a*o)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Oe("KeyframeTrack: Invalid value size in track.",this),e=!1);let n=this.times,s=this.values,r=n.length;r===0&&(Oe("KeyframeTrack: Track is empty.",this),e=!1);let a=null;for(let o=0;o!==r;o++){let l=n[o];if(typeof l=="number"&&isNaN(l)){Oe("KeyframeTrack: Time is not a valid number.",this,o,l),e=!1;break}if(a!==null&&a>l){Oe("KeyframeTrack: Out of order keys.",this,o,l,a),e=!1;break}a=l}if(s!==void 0&&Kp(s))for(let o=0,l=s.length;o!==l;++o){let c=s[o];if(isNaN(c)){Oe("KeyframeTrack: Value is not a valid number.",this,o,c),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===Pa,r=e.length-1,a=1;for(let o=1;o<r;++o){let l=!1,c=e[o],h=e[o+1];if(c!==h&&(o!==1||c!==e[0]))if(s)l=!0;else{let d=o*n,u=d-n,f=d+n;for(let _=0;_!==n;++_){let M=t[d+_];if(M!==t[u+_]||M!==t[f+_]){l=!0;break}}}if(l){if(o!==a){e[a]=e[o];let d=o*n,u=a*n;for(let f=0;f!==n;++f)t[u+f]=t[d+f]}++a}}if(r>0){e[a]=e[r];for(let o=r*n,l=a*n,c=0;c!==n;++c)t[l+c]=t[o+c];++a}return a!==e.length?(this.times=e.slice(0,a),this.values=t.slice(0,a*n)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,s=new n(this.name,e,t);return s.createInterpolant=this.createInterpolant,Ta(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function Pu(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]+=e}function Iu(i,e){for(let t=0,n=i.length;t!==n;t+=2)i[t]*=e}cn.prototype.ValueTypeName="";cn.prototype.TimeBufferType=Float32Array;cn.prototype.ValueBufferType=Float32Array;cn.prototype.DefaultInterpolation=za;var yi=class extends cn{constructor(e,t,n){super(e,t,n)}};yi.prototype.ValueTypeName="bool";yi.prototype.ValueBufferType=Array;yi.prototype.DefaultInterpolation=Ks;yi.prototype.InterpolantFactoryMethodLinear=void 0;yi.prototype.InterpolantFactoryMethodSmooth=void 0;var ja=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}};ja.prototype.ValueTypeName="color";var Qa=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}};Qa.prototype.ValueTypeName="number";var eo=class extends _i{constructor(e,t,n,s){super(e,t,n,s)}interpolate_(e,t,n,s){let r=this.resultBuffer,a=this.sampleValues,o=this.valueSize,l=(n-t)/(s-t),c=e*o;for(let h=c+o;c!==h;c+=4)on.slerpFlat(r,0,a,c-o,a,c,l);return r}},cr=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}InterpolantFactoryMethodLinear(e){return new eo(this.times,this.values,this.getValueSize(),e)}};cr.prototype.ValueTypeName="quaternion";cr.prototype.InterpolantFactoryMethodSmooth=void 0;var vi=class extends cn{constructor(e,t,n){super(e,t,n)}};vi.prototype.ValueTypeName="string";vi.prototype.ValueBufferType=Array;vi.prototype.DefaultInterpolation=Ks;vi.prototype.InterpolantFactoryMethodLinear=void 0;vi.prototype.InterpolantFactoryMethodSmooth=void 0;var to=class extends cn{constructor(e,t,n,s){super(e,t,n,s)}};to.prototype.ValueTypeName="vector";var no=class{constructor(e,t,n){let s=this,r=!1,a=0,o=0,l,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=n,this._abortController=null,this.itemStart=function(h){o++,r===!1&&s.onStart!==void 0&&s.onStart(h,a,o),r=!0},this.itemEnd=function(h){a++,s.onProgress!==void 0&&s.onProgress(h,a,o),a===o&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(h){s.onError!==void 0&&s.onError(h)},this.resolveURL=function(h){return h=h.normalize("NFC"),l?l(h):h},this.setURLModifier=function(h){return l=h,this},this.addHandler=function(h,d){return c.push(h,d),this},this.removeHandler=function(h){let d=c.indexOf(h);return d!==-1&&c.splice(d,2),this},this.getHandler=function(h){for(let d=0,u=c.length;d<u;d+=2){let f=c[d],_=c[d+1];if(f.global&&(f.lastIndex=0),f.test(h))return _}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},wd=new no,io=class{constructor(e){this.manager=e!==void 0?e:wd,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let n=this;return new Promise(function(s,r){n.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};io.DEFAULT_MATERIAL_NAME="__DEFAULT";var hr=class extends Xt{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type="Light",this.color=new Ge(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}};var Xl=new ut,Lu=new z,Du=new z,so=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new Be(512,512),this.mapType=en,this.map=null,this.mapPass=null,this.matrix=new ut,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new gi,this._frameExtents=new Be(1,1),this._viewportCount=1,this._viewports=[new gt(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;Lu.setFromMatrixPosition(e.matrixWorld),t.position.copy(Lu),Du.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(Du),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,s){Xl.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix(Xl,e.coordinateSystem,e.reversedDepth);let r=this._frameExtents,a=s?s.z/r.x:1,o=s?s.w/r.y:1,l=s?s.x/r.x:0,c=s?s.y/r.y:0;e.coordinateSystem===ys||e.reversedDepth?t.set(.5*a,0,0,.5*a+l,0,.5*o,0,.5*o+c,0,0,1,0,0,0,0,1):t.set(.5*a,0,0,.5*a+l,0,.5*o,0,.5*o+c,0,0,.5,.5,0,0,0,1),t.multiply(Xl)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},Ra=new z,Ca=new on,Rn=new z,ur=class extends Xt{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new ut,this.projectionMatrix=new ut,this.projectionMatrixInverse=new ut,this.coordinateSystem=pn,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Ra,Ca,Rn),Rn.x===1&&Rn.y===1&&Rn.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Ra,Ca,Rn.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(Ra,Ca,Rn),Rn.x===1&&Rn.y===1&&Rn.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Ra,Ca,Rn.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},di=new z,Nu=new Be,Uu=new Be,Wt=class extends ur{constructor(e=50,t=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=xs*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan($s*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return xs*2*Math.atan(Math.tan($s*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){di.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(di.x,di.y).multiplyScalar(-e/di.z),di.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(di.x,di.y).multiplyScalar(-e/di.z)}getViewSize(e,t){return this.getViewBounds(e,Nu,Uu),t.subVectors(Uu,Nu)}setViewOffset(e,t,n,s,r,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan($s*.5*this.fov)/this.zoom,n=2*t,s=this.aspect*n,r=-.5*s,a=this.view;if(this.view!==null&&this.view.enabled){let l=a.fullWidth,c=a.fullHeight;r+=a.offsetX*s/l,t-=a.offsetY*n/c,s*=a.width/l,n*=a.height/c}let o=this.filmOffset;o!==0&&(r+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var dr=class extends ur{constructor(e=-1,t=1,n=1,s=-1,r=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=s,this.near=r,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,s,r,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-e,a=n+e,o=s+t,l=s-t;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,a=r+c*this.view.width,o-=h*this.view.offsetY,l=o-h*this.view.height}this.projectionMatrix.makeOrthographic(r,a,o,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},Kl=class extends so{constructor(){super(new dr(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},fr=class extends hr{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(Xt.DEFAULT_UP),this.updateMatrix(),this.target=new Xt,this.shadow=new Kl}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}};var Es=class{constructor(){this.isSphericalHarmonics3=!0,this.coefficients=[];for(let e=0;e<9;e++)this.coefficients.push(new z)}set(e){for(let t=0;t<9;t++)this.coefficients[t].copy(e[t]);return this}zero(){for(let e=0;e<9;e++)this.coefficients[e].set(0,0,0);return this}getAt(e,t){let n=e.x,s=e.y,r=e.z,a=this.coefficients;return t.copy(a[0]).multiplyScalar(.282095),t.addScaledVector(a[1],.488603*s),t.addScaledVector(a[2],.488603*r),t.addScaledVector(a[3],.488603*n),t.addScaledVector(a[4],1.092548*(n*s)),t.addScaledVector(a[5],1.092548*(s*r)),t.addScaledVector(a[6],.315392*(3*r*r-1)),t.addScaledVector(a[7],1.092548*(n*r)),t.addScaledVector(a[8],.546274*(n*n-s*s)),t}getIrradianceAt(e,t){let n=e.x,s=e.y,r=e.z,a=this.coefficients;return t.copy(a[0]).multiplyScalar(.886227),t.addScaledVector(a[1],2*.511664*s),t.addScaledVector(a[2],2*.511664*r),t.addScaledVector(a[3],2*.511664*n),t.addScaledVector(a[4],2*.429043*n*s),t.addScaledVector(a[5],2*.429043*s*r),t.addScaledVector(a[6],.743125*r*r-.247708),t.addScaledVector(a[7],2*.429043*n*r),t.addScaledVector(a[8],.429043*(n*n-s*s)),t}add(e){for(let t=0;t<9;t++)this.coefficients[t].add(e.coefficients[t]);return this}addScaledSH(e,t){for(let n=0;n<9;n++)this.coefficients[n].addScaledVector(e.coefficients[n],t);return this}scale(e){for(let t=0;t<9;t++)this.coefficients[t].multiplyScalar(e);return this}lerp(e,t){for(let n=0;n<9;n++)this.coefficients[n].lerp(e.coefficients[n],t);return this}equals(e){for(let t=0;t<9;t++)if(!this.coefficients[t].equals(e.coefficients[t]))return!1;return!0}copy(e){return this.set(e.coefficients)}clone(){return new this.constructor().copy(this)}fromArray(e,t=0){let n=this.coefficients;for(let s=0;s<9;s++)n[s].fromArray(e,t+s*3);return this}toArray(e=[],t=0){let n=this.coefficients;for(let s=0;s<9;s++)n[s].toArray(e,t+s*3);return e}static getBasisAt(e,t){let n=e.x,s=e.y,r=e.z;t[0]=.282095,t[1]=.488603*s,t[2]=.488603*r,t[3]=.488603*n,t[4]=1.092548*n*s,t[5]=1.092548*s*r,t[6]=.315392*(3*r*r-1),t[7]=1.092548*n*r,t[8]=.546274*(n*n-s*s)}},pr=class extends hr{constructor(e=new Es,t=1){super(void 0,t),this.isLightProbe=!0,this.type="LightProbe",this.sh=e}copy(e){return super.copy(e),this.sh.copy(e.sh),this}toJSON(e){let t=super.toJSON(e);return t.object.sh=this.sh.toArray(),t}};var fs=-90,ps=1,As=class extends Xt{constructor(e,t,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new Wt(fs,ps,e,t);s.layers=this.layers,this.add(s);let r=new Wt(fs,ps,e,t);r.layers=this.layers,this.add(r);let a=new Wt(fs,ps,e,t);a.layers=this.layers,this.add(a);let o=new Wt(fs,ps,e,t);o.layers=this.layers,this.add(o);let l=new Wt(fs,ps,e,t);l.layers=this.layers,this.add(l);let c=new Wt(fs,ps,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,s,r,a,o,l]=t;for(let c of t)this.remove(c);if(e===pn)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===ys)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,a,o,l,c,h]=this.children,d=e.getRenderTarget(),u=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),_=e.xr.enabled;e.xr.enabled=!1;let M=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let p=!1;e.isWebGLRenderer===!0?p=e.state.buffers.depth.getReversed():p=e.reversedDepthBuffer,e.setRenderTarget(n,0,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(n,1,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(n,4,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=M,e.setRenderTarget(n,5,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,h),e.setRenderTarget(d,u,f),e.xr.enabled=_,n.texture.needsPMREMUpdate=!0}},ro=class extends Wt{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var Cc="\\[\\]\\.:\\/",Bm=new RegExp("["+Cc+"]","g"),Pc="[^"+Cc+"]",km="[^"+Cc.replace("\\.","")+"]",zm=/((?:WC+[\/:])*)/.source.replace("WC",Pc),Vm=/(WCOD+)?/.source.replace("WCOD",km),Gm=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",Pc),Hm=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",Pc),Wm=new RegExp("^"+zm+Vm+Gm+Hm+"$"),Xm=["material","materials","bones","map"],Jl=class{constructor(e,t,n){let s=n||ft.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},ft=class i{constructor(e,t,n){this.path=t,this.parsedPath=n||i.parseTrackName(t),this.node=i.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,n){return e&&e.isAnimationObjectGroup?new i.Composite(e,t,n):new i(e,t,n)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace(Bm,"")}static parseTrackName(e){let t=Wm.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);Xm.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return n}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(r){for(let a=0;a<r.length;a++){let o=r[a];if(o.name===t||o.uuid===t)return o;let l=n(o.children);if(l)return l}return null},s=n(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)e[t++]=n[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,n=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=i.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){Ne("PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=t.objectIndex;switch(n){case"materials":if(!e.material){Oe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){Oe("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){Oe("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let h=0;h<e.length;h++)if(e[h].name===c){c=h;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){Oe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){Oe("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[n]===void 0){Oe("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[n]}if(c!==void 0){if(e[c]===void 0){Oe("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[c]}}let a=e[s];if(a===void 0){let c=t.nodeName;Oe("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",e);return}let o=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?o=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(o=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){Oe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){Oe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=a,this.propertyIndex=r}else a.fromArray!==void 0&&a.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=a):Array.isArray(a)?(l=this.BindingType.EntireArray,this.resolvedProperty=a):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][o]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};ft.Composite=Jl;ft.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};ft.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};ft.prototype.GetterByBindingType=[ft.prototype._getValue_direct,ft.prototype._getValue_array,ft.prototype._getValue_arrayElement,ft.prototype._getValue_toArray];ft.prototype.SetterByBindingTypeAndVersioning=[[ft.prototype._setValue_direct,ft.prototype._setValue_direct_setNeedsUpdate,ft.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[ft.prototype._setValue_array,ft.prototype._setValue_array_setNeedsUpdate,ft.prototype._setValue_array_setMatrixWorldNeedsUpdate],[ft.prototype._setValue_arrayElement,ft.prototype._setValue_arrayElement_setNeedsUpdate,ft.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[ft.prototype._setValue_fromArray,ft.prototype._setValue_fromArray_setNeedsUpdate,ft.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var $M=new Float32Array(1);var Dn=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=We(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(We(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var jl=class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=n,r[3]=s,this}};var mr=class extends bn{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Ic(i,e,t,n){let s=qm(n);switch(t){case _c:return i*e;case vc:return i*e/s.components*s.byteLength;case uo:return i*e/s.components*s.byteLength;case Mi:return i*e*2/s.components*s.byteLength;case fo:return i*e*2/s.components*s.byteLength;case yc:return i*e*3/s.components*s.byteLength;case wn:return i*e*4/s.components*s.byteLength;case po:return i*e*4/s.components*s.byteLength;case vr:case xr:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case br:case Mr:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case go:case yo:return Math.max(i,16)*Math.max(e,8)/4;case mo:case _o:return Math.max(i,8)*Math.max(e,8)/2;case vo:case xo:case Mo:case So:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*8;case bo:case Sr:case wo:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Eo:return Math.floor((i+3)/4)*Math.floor((e+3)/4)*16;case Ao:return Math.floor((i+4)/5)*Math.floor((e+3)/4)*16;case To:return Math.floor((i+4)/5)*Math.floor((e+4)/5)*16;case Ro:return Math.floor((i+5)/6)*Math.floor((e+4)/5)*16;case Co:return Math.floor((i+5)/6)*Math.floor((e+5)/6)*16;case Po:return Math.floor((i+7)/8)*Math.floor((e+4)/5)*16;case Io:return Math.floor((i+7)/8)*Math.floor((e+5)/6)*16;case Lo:return Math.floor((i+7)/8)*Math.floor((e+7)/8)*16;case Do:return Math.floor((i+9)/10)*Math.floor((e+4)/5)*16;case No:return Math.floor((i+9)/10)*Math.floor((e+5)/6)*16;case Uo:return Math.floor((i+9)/10)*Math.floor((e+7)/8)*16;case Fo:return Math.floor((i+9)/10)*Math.floor((e+9)/10)*16;case Oo:return Math.floor((i+11)/12)*Math.floor((e+9)/10)*16;case Bo:return Math.floor((i+11)/12)*Math.floor((e+11)/12)*16;case ko:case zo:case Vo:return Math.ceil(i/4)*Math.ceil(e/4)*16;case Go:case Ho:return Math.ceil(i/4)*Math.ceil(e/4)*8;case wr:case Wo:return Math.ceil(i/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function qm(i){switch(i){case en:case fc:return{byteLength:1,components:1};case Is:case pc:case hn:return{byteLength:2,components:1};case co:case ho:return{byteLength:2,components:4};case Mn:case lo:case Sn:return{byteLength:4,components:1};case mc:case gc:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${i}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?Ne("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function qd(){let i=null,e=!1,t=null,n=null;function s(r,a){n=i.requestAnimationFrame(s),t(r,a)}return{start:function(){e!==!0&&t!==null&&i!==null&&(n=i.requestAnimationFrame(s),e=!0)},stop:function(){i!==null&&i.cancelAnimationFrame(n),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){i=r}}}function $m(i){let e=new WeakMap;function t(o,l){let c=o.array,h=o.usage,d=c.byteLength,u=i.createBuffer();i.bindBuffer(l,u),i.bufferData(l,c,h),o.onUploadCallback();let f;if(c instanceof Float32Array)f=i.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)f=i.HALF_FLOAT;else if(c instanceof Uint16Array)o.isFloat16BufferAttribute?f=i.HALF_FLOAT:f=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)f=i.SHORT;else if(c instanceof Uint32Array)f=i.UNSIGNED_INT;else if(c instanceof Int32Array)f=i.INT;else if(c instanceof Int8Array)f=i.BYTE;else if(c instanceof Uint8Array)f=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)f=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:u,type:f,bytesPerElement:c.BYTES_PER_ELEMENT,version:o.version,size:d}}function n(o,l,c){let h=l.array,d=l.updateRanges;if(i.bindBuffer(c,o),d.length===0)i.bufferSubData(c,0,h);else{d.sort((f,_)=>f.start-_.start);let u=0;for(let f=1;f<d.length;f++){let _=d[u],M=d[f];M.start<=_.start+_.count+1?_.count=Math.max(_.count,M.start+M.count-_.start):(++u,d[u]=M)}d.length=u+1;for(let f=0,_=d.length;f<_;f++){let M=d[f];i.bufferSubData(c,M.start*h.BYTES_PER_ELEMENT,h,M.start,M.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(o){return o.isInterleavedBufferAttribute&&(o=o.data),e.get(o)}function r(o){o.isInterleavedBufferAttribute&&(o=o.data);let l=e.get(o);l&&(i.deleteBuffer(l.buffer),e.delete(o))}function a(o,l){if(o.isInterleavedBufferAttribute&&(o=o.data),o.isGLBufferAttribute){let h=e.get(o);(!h||h.version<o.version)&&e.set(o,{buffer:o.buffer,type:o.type,bytesPerElement:o.elementSize,version:o.version});return}let c=e.get(o);if(c===void 0)e.set(o,t(o,l));else if(c.version<o.version){if(c.size!==o.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,o,l),c.version=o.version}}return{get:s,remove:r,update:a}}var Zm=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,Km=`#ifdef USE_ALPHAHASH
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
#endif`,Jm=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,jm=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Qm=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,eg=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,tg=`#ifdef USE_AOMAP
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
#endif`,ng=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,ig=`#ifdef USE_BATCHING
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
#endif`,sg=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,rg=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,ag=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,og=`float G_BlinnPhong_Implicit( ) {
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
} // validated`,lg=`#ifdef USE_IRIDESCENCE
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
#endif`,cg=`#ifdef USE_BUMPMAP
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
#endif`,hg=`#if NUM_CLIPPING_PLANES > 0
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
#endif`,ug=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,dg=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,fg=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,pg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,mg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,gg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,_g=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
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
#endif`,yg=`#define PI 3.141592653589793
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
} // validated`,vg=`vec3 transformedNormal = objectNormal;
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
#endif`,xg=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,bg=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Mg=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Sg=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,wg="gl_FragColor = linearToOutputTexel( gl_FragColor );",Eg=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Ag=`#ifdef USE_ENVMAP
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
#endif`,Tg=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,Rg=`#ifdef USE_ENVMAP
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
#endif`,Cg=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,Pg=`#ifdef USE_ENVMAP
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
#endif`,Ig=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,Lg=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Dg=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Ng=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Ug=`#ifdef USE_GRADIENTMAP
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
}`,Fg=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,Og=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Bg=`varying vec3 vViewPosition;
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
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,kg=`uniform bool receiveShadow;
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
#include <lightprobes_pars_fragment>`,zg=`#ifdef USE_ENVMAP
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
#endif`,Vg=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Gg=`varying vec3 vViewPosition;
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
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,Hg=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Wg=`varying vec3 vViewPosition;
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
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Xg=`PhysicalMaterial material;
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
#endif`,qg=`uniform sampler2D dfgLUT;
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
}`,Yg=`
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
#endif`,$g=`#if defined( RE_IndirectDiffuse )
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
#endif`,Zg=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,Kg=`#if NUM_LIGHT_PROBE_GRIDS > 0
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
#endif`,Jg=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,jg=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Qg=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,e0=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,t0=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,n0=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,i0=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
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
#endif`,s0=`#if defined( USE_POINTS_UV )
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
#endif`,r0=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,a0=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,o0=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,l0=`#if defined( USE_MORPHCOLORS )
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
#endif`,c0=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,h0=`#ifdef USE_MORPHTARGETS
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
#endif`,u0=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,d0=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
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
vec3 nonPerturbedNormal = normal;`,f0=`#ifdef USE_NORMALMAP_OBJECTSPACE
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
#endif`,p0=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,m0=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,g0=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,_0=`#ifdef USE_NORMALMAP
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
#endif`,y0=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,v0=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,x0=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,b0=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,M0=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,S0=`vec3 packNormalToRGB( const in vec3 normal ) {
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
}`,w0=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,E0=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,A0=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,T0=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,R0=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,C0=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,P0=`#if NUM_SPOT_LIGHT_COORDS > 0
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
#endif`,I0=`#if NUM_SPOT_LIGHT_COORDS > 0
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
#endif`,L0=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
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
#endif`,D0=`float getShadowMask() {
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
}`,N0=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,U0=`#ifdef USE_SKINNING
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
#endif`,F0=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,O0=`#ifdef USE_SKINNING
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
#endif`,B0=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,k0=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,z0=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,V0=`#ifndef saturate
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
vec3 CustomToneMapping( vec3 color ) { return color; }`,G0=`#ifdef USE_TRANSMISSION
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
#endif`,H0=`#ifdef USE_TRANSMISSION
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
#endif`,W0=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
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
#endif`,X0=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
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
#endif`,q0=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
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
#endif`,Y0=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,$0=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,Z0=`uniform sampler2D t2D;
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
}`,K0=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,J0=`uniform float backgroundBlurriness;
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
}`,j0=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,Q0=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,e_=`#include <common>
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
}`,t_=`#if DEPTH_PACKING == 3200
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
}`,n_=`#define DISTANCE
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
}`,i_=`#define DISTANCE
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
}`,s_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,r_=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,a_=`uniform float scale;
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
}`,o_=`uniform vec3 diffuse;
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
}`,l_=`#include <common>
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
}`,c_=`uniform vec3 diffuse;
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
}`,h_=`#define LAMBERT
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
}`,u_=`#define LAMBERT
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
}`,d_=`#define MATCAP
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
}`,f_=`#define MATCAP
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
}`,p_=`#define NORMAL
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
}`,m_=`#define NORMAL
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
}`,g_=`#define PHONG
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
}`,__=`#define PHONG
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
}`,y_=`#define STANDARD
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
}`,v_=`#define STANDARD
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
}`,x_=`#define TOON
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
}`,b_=`#define TOON
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
}`,M_=`uniform float size;
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
}`,S_=`uniform vec3 diffuse;
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
}`,w_=`#include <common>
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
}`,E_=`uniform vec3 color;
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
}`,A_=`uniform float rotation;
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
}`,T_=`uniform vec3 diffuse;
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
}`,He={alphahash_fragment:Zm,alphahash_pars_fragment:Km,alphamap_fragment:Jm,alphamap_pars_fragment:jm,alphatest_fragment:Qm,alphatest_pars_fragment:eg,aomap_fragment:tg,aomap_pars_fragment:ng,batching_pars_vertex:ig,batching_vertex:sg,begin_vertex:rg,beginnormal_vertex:ag,bsdfs:og,iridescence_fragment:lg,bumpmap_pars_fragment:cg,clipping_planes_fragment:hg,clipping_planes_pars_fragment:ug,clipping_planes_pars_vertex:dg,clipping_planes_vertex:fg,color_fragment:pg,color_pars_fragment:mg,color_pars_vertex:gg,color_vertex:_g,common:yg,defaultnormal_vertex:vg,displacementmap_pars_vertex:xg,displacementmap_vertex:bg,emissivemap_fragment:Mg,emissivemap_pars_fragment:Sg,colorspace_fragment:wg,colorspace_pars_fragment:Eg,envmap_fragment:Ag,envmap_common_pars_fragment:Tg,envmap_pars_fragment:Rg,envmap_pars_vertex:Cg,envmap_physical_pars_fragment:zg,envmap_vertex:Pg,fog_vertex:Ig,fog_pars_vertex:Lg,fog_fragment:Dg,fog_pars_fragment:Ng,gradientmap_pars_fragment:Ug,lightmap_pars_fragment:Fg,lights_lambert_fragment:Og,lights_lambert_pars_fragment:Bg,lights_pars_begin:kg,lights_toon_fragment:Vg,lights_toon_pars_fragment:Gg,lights_phong_fragment:Hg,lights_phong_pars_fragment:Wg,lights_physical_fragment:Xg,lights_physical_pars_fragment:qg,lights_fragment_begin:Yg,lights_fragment_maps:$g,lights_fragment_end:Zg,lightprobes_pars_fragment:Kg,logdepthbuf_fragment:Jg,logdepthbuf_pars_fragment:jg,logdepthbuf_pars_vertex:Qg,logdepthbuf_vertex:e0,map_fragment:t0,map_pars_fragment:n0,map_particle_fragment:i0,map_particle_pars_fragment:s0,metalnessmap_fragment:r0,metalnessmap_pars_fragment:a0,morphinstance_vertex:o0,morphcolor_vertex:l0,morphnormal_vertex:c0,morphtarget_pars_vertex:h0,morphtarget_vertex:u0,normal_fragment_begin:d0,normal_fragment_maps:f0,normal_pars_fragment:p0,normal_pars_vertex:m0,normal_vertex:g0,normalmap_pars_fragment:_0,clearcoat_normal_fragment_begin:y0,clearcoat_normal_fragment_maps:v0,clearcoat_pars_fragment:x0,iridescence_pars_fragment:b0,opaque_fragment:M0,packing:S0,premultiplied_alpha_fragment:w0,project_vertex:E0,dithering_fragment:A0,dithering_pars_fragment:T0,roughnessmap_fragment:R0,roughnessmap_pars_fragment:C0,shadowmap_pars_fragment:P0,shadowmap_pars_vertex:I0,shadowmap_vertex:L0,shadowmask_pars_fragment:D0,skinbase_vertex:N0,skinning_pars_vertex:U0,skinning_vertex:F0,skinnormal_vertex:O0,specularmap_fragment:B0,specularmap_pars_fragment:k0,tonemapping_fragment:z0,tonemapping_pars_fragment:V0,transmission_fragment:G0,transmission_pars_fragment:H0,uv_pars_fragment:W0,uv_pars_vertex:X0,uv_vertex:q0,worldpos_vertex:Y0,background_vert:$0,background_frag:Z0,backgroundCube_vert:K0,backgroundCube_frag:J0,cube_vert:j0,cube_frag:Q0,depth_vert:e_,depth_frag:t_,distance_vert:n_,distance_frag:i_,equirect_vert:s_,equirect_frag:r_,linedashed_vert:a_,linedashed_frag:o_,meshbasic_vert:l_,meshbasic_frag:c_,meshlambert_vert:h_,meshlambert_frag:u_,meshmatcap_vert:d_,meshmatcap_frag:f_,meshnormal_vert:p_,meshnormal_frag:m_,meshphong_vert:g_,meshphong_frag:__,meshphysical_vert:y_,meshphysical_frag:v_,meshtoon_vert:x_,meshtoon_frag:b_,points_vert:M_,points_frag:S_,shadow_vert:w_,shadow_frag:E_,sprite_vert:A_,sprite_frag:T_},xe={common:{diffuse:{value:new Ge(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new ze},alphaMap:{value:null},alphaMapTransform:{value:new ze},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new ze}},envmap:{envMap:{value:null},envMapRotation:{value:new ze},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new ze}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new ze}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new ze},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new ze},normalScale:{value:new Be(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new ze},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new ze}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new ze}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new ze}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Ge(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Ge(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new ze},alphaTest:{value:0},uvTransform:{value:new ze}},sprite:{diffuse:{value:new Ge(16777215)},opacity:{value:1},center:{value:new Be(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new ze},alphaMap:{value:null},alphaMapTransform:{value:new ze},alphaTest:{value:0}}},Bn={basic:{uniforms:Vt([xe.common,xe.specularmap,xe.envmap,xe.aomap,xe.lightmap,xe.fog]),vertexShader:He.meshbasic_vert,fragmentShader:He.meshbasic_frag},lambert:{uniforms:Vt([xe.common,xe.specularmap,xe.envmap,xe.aomap,xe.lightmap,xe.emissivemap,xe.bumpmap,xe.normalmap,xe.displacementmap,xe.fog,xe.lights,{emissive:{value:new Ge(0)},envMapIntensity:{value:1}}]),vertexShader:He.meshlambert_vert,fragmentShader:He.meshlambert_frag},phong:{uniforms:Vt([xe.common,xe.specularmap,xe.envmap,xe.aomap,xe.lightmap,xe.emissivemap,xe.bumpmap,xe.normalmap,xe.displacementmap,xe.fog,xe.lights,{emissive:{value:new Ge(0)},specular:{value:new Ge(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:He.meshphong_vert,fragmentShader:He.meshphong_frag},standard:{uniforms:Vt([xe.common,xe.envmap,xe.aomap,xe.lightmap,xe.emissivemap,xe.bumpmap,xe.normalmap,xe.displacementmap,xe.roughnessmap,xe.metalnessmap,xe.fog,xe.lights,{emissive:{value:new Ge(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:He.meshphysical_vert,fragmentShader:He.meshphysical_frag},toon:{uniforms:Vt([xe.common,xe.aomap,xe.lightmap,xe.emissivemap,xe.bumpmap,xe.normalmap,xe.displacementmap,xe.gradientmap,xe.fog,xe.lights,{emissive:{value:new Ge(0)}}]),vertexShader:He.meshtoon_vert,fragmentShader:He.meshtoon_frag},matcap:{uniforms:Vt([xe.common,xe.bumpmap,xe.normalmap,xe.displacementmap,xe.fog,{matcap:{value:null}}]),vertexShader:He.meshmatcap_vert,fragmentShader:He.meshmatcap_frag},points:{uniforms:Vt([xe.points,xe.fog]),vertexShader:He.points_vert,fragmentShader:He.points_frag},dashed:{uniforms:Vt([xe.common,xe.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:He.linedashed_vert,fragmentShader:He.linedashed_frag},depth:{uniforms:Vt([xe.common,xe.displacementmap]),vertexShader:He.depth_vert,fragmentShader:He.depth_frag},normal:{uniforms:Vt([xe.common,xe.bumpmap,xe.normalmap,xe.displacementmap,{opacity:{value:1}}]),vertexShader:He.meshnormal_vert,fragmentShader:He.meshnormal_frag},sprite:{uniforms:Vt([xe.sprite,xe.fog]),vertexShader:He.sprite_vert,fragmentShader:He.sprite_frag},background:{uniforms:{uvTransform:{value:new ze},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:He.background_vert,fragmentShader:He.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new ze}},vertexShader:He.backgroundCube_vert,fragmentShader:He.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:He.cube_vert,fragmentShader:He.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:He.equirect_vert,fragmentShader:He.equirect_frag},distance:{uniforms:Vt([xe.common,xe.displacementmap,{referencePosition:{value:new z},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:He.distance_vert,fragmentShader:He.distance_frag},shadow:{uniforms:Vt([xe.lights,xe.fog,{color:{value:new Ge(0)},opacity:{value:1}}]),vertexShader:He.shadow_vert,fragmentShader:He.shadow_frag}};Bn.physical={uniforms:Vt([Bn.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new ze},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new ze},clearcoatNormalScale:{value:new Be(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new ze},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new ze},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new ze},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new ze},sheen:{value:0},sheenColor:{value:new Ge(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new ze},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new ze},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new ze},transmissionSamplerSize:{value:new Be},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new ze},attenuationDistance:{value:0},attenuationColor:{value:new Ge(0)},specularColor:{value:new Ge(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new ze},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new ze},anisotropyVector:{value:new Be},anisotropyMap:{value:null},anisotropyMapTransform:{value:new ze}}]),vertexShader:He.meshphysical_vert,fragmentShader:He.meshphysical_frag};var qo={r:0,b:0,g:0},R_=new ut,Yd=new ze;Yd.set(-1,0,0,0,1,0,0,0,1);function C_(i,e,t,n,s,r){let a=new Ge(0),o=s===!0?0:1,l,c,h=null,d=0,u=null;function f(S){let P=S.isScene===!0?S.background:null;if(P&&P.isTexture){let w=S.backgroundBlurriness>0;P=e.get(P,w)}return P}function _(S){let P=!1,w=f(S);w===null?p(a,o):w&&w.isColor&&(p(w,1),P=!0);let I=i.xr.getEnvironmentBlendMode();I==="additive"?t.buffers.color.setClear(0,0,0,1,r):I==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(i.autoClear||P)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function M(S,P){let w=f(P);w&&w.isCubeTexture?(c===void 0&&(c=new qt(new ws(1,1,1),new Ln({name:"BackgroundCubeMaterial",uniforms:Hi(Bn.backgroundCube.uniforms),vertexShader:Bn.backgroundCube.vertexShader,fragmentShader:Bn.backgroundCube.fragmentShader,side:Yt,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(I,R,y){this.matrixWorld.copyPosition(y.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),n.update(c)),c.material.uniforms.envMap.value=w,c.material.uniforms.backgroundBlurriness.value=P.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=P.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(R_.makeRotationFromEuler(P.backgroundRotation)).transpose(),w.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(Yd),c.material.toneMapped=Ke.getTransfer(w.colorSpace)!==st,(h!==w||d!==w.version||u!==i.toneMapping)&&(c.material.needsUpdate=!0,h=w,d=w.version,u=i.toneMapping),c.layers.enableAll(),S.unshift(c,c.geometry,c.material,0,0,null)):w&&w.isTexture&&(l===void 0&&(l=new qt(new Oi(2,2),new Ln({name:"BackgroundMaterial",uniforms:Hi(Bn.background.uniforms),vertexShader:Bn.background.vertexShader,fragmentShader:Bn.background.fragmentShader,side:Nn,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),n.update(l)),l.material.uniforms.t2D.value=w,l.material.uniforms.backgroundIntensity.value=P.backgroundIntensity,l.material.toneMapped=Ke.getTransfer(w.colorSpace)!==st,w.matrixAutoUpdate===!0&&w.updateMatrix(),l.material.uniforms.uvTransform.value.copy(w.matrix),(h!==w||d!==w.version||u!==i.toneMapping)&&(l.material.needsUpdate=!0,h=w,d=w.version,u=i.toneMapping),l.layers.enableAll(),S.unshift(l,l.geometry,l.material,0,0,null))}function p(S,P){S.getRGB(qo,Rc(i)),t.buffers.color.setClear(qo.r,qo.g,qo.b,P,r)}function g(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return a},setClearColor:function(S,P=1){a.set(S),o=P,p(a,o)},getClearAlpha:function(){return o},setClearAlpha:function(S){o=S,p(a,o)},render:_,addToRenderList:M,dispose:g}}function P_(i,e){let t=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=u(null),r=s,a=!1;function o(V,$,Q,U,J){let se=!1,Z=d(V,U,Q,$);r!==Z&&(r=Z,c(r.object)),se=f(V,U,Q,J),se&&_(V,U,Q,J),J!==null&&e.update(J,i.ELEMENT_ARRAY_BUFFER),(se||a)&&(a=!1,w(V,$,Q,U),J!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,e.get(J).buffer))}function l(){return i.createVertexArray()}function c(V){return i.bindVertexArray(V)}function h(V){return i.deleteVertexArray(V)}function d(V,$,Q,U){let J=U.wireframe===!0,se=n[$.id];se===void 0&&(se={},n[$.id]=se);let Z=V.isInstancedMesh===!0?V.id:0,he=se[Z];he===void 0&&(he={},se[Z]=he);let K=he[Q.id];K===void 0&&(K={},he[Q.id]=K);let oe=K[J];return oe===void 0&&(oe=u(l()),K[J]=oe),oe}function u(V){let $=[],Q=[],U=[];for(let J=0;J<t;J++)$[J]=0,Q[J]=0,U[J]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:$,enabledAttributes:Q,attributeDivisors:U,object:V,attributes:{},index:null}}function f(V,$,Q,U){let J=r.attributes,se=$.attributes,Z=0,he=Q.getAttributes();for(let K in he)if(he[K].location>=0){let le=J[K],Re=se[K];if(Re===void 0&&(K==="instanceMatrix"&&V.instanceMatrix&&(Re=V.instanceMatrix),K==="instanceColor"&&V.instanceColor&&(Re=V.instanceColor)),le===void 0||le.attribute!==Re||Re&&le.data!==Re.data)return!0;Z++}return r.attributesNum!==Z||r.index!==U}function _(V,$,Q,U){let J={},se=$.attributes,Z=0,he=Q.getAttributes();for(let K in he)if(he[K].location>=0){let le=se[K];le===void 0&&(K==="instanceMatrix"&&V.instanceMatrix&&(le=V.instanceMatrix),K==="instanceColor"&&V.instanceColor&&(le=V.instanceColor));let Re={};Re.attribute=le,le&&le.data&&(Re.data=le.data),J[K]=Re,Z++}r.attributes=J,r.attributesNum=Z,r.index=U}function M(){let V=r.newAttributes;for(let $=0,Q=V.length;$<Q;$++)V[$]=0}function p(V){g(V,0)}function g(V,$){let Q=r.newAttributes,U=r.enabledAttributes,J=r.attributeDivisors;Q[V]=1,U[V]===0&&(i.enableVertexAttribArray(V),U[V]=1),J[V]!==$&&(i.vertexAttribDivisor(V,$),J[V]=$)}function S(){let V=r.newAttributes,$=r.enabledAttributes;for(let Q=0,U=$.length;Q<U;Q++)$[Q]!==V[Q]&&(i.disableVertexAttribArray(Q),$[Q]=0)}function P(V,$,Q,U,J,se,Z){Z===!0?i.vertexAttribIPointer(V,$,Q,J,se):i.vertexAttribPointer(V,$,Q,U,J,se)}function w(V,$,Q,U){M();let J=U.attributes,se=Q.getAttributes(),Z=$.defaultAttributeValues;for(let he in se){let K=se[he];if(K.location>=0){let oe=J[he];if(oe===void 0&&(he==="instanceMatrix"&&V.instanceMatrix&&(oe=V.instanceMatrix),he==="instanceColor"&&V.instanceColor&&(oe=V.instanceColor)),oe!==void 0){let le=oe.normalized,Re=oe.itemSize,ke=e.get(oe);if(ke===void 0)continue;let ne=ke.buffer,ve=ke.type,Me=ke.bytesPerElement,Pe=ve===i.INT||ve===i.UNSIGNED_INT||oe.gpuType===lo;if(oe.isInterleavedBufferAttribute){let _e=oe.data,Ue=_e.isInterleavedBuffer===!0?_e.stride:_e.itemSize,dt=oe.offset;if(_e.isInstancedInterleavedBuffer||_e.isInstancedBufferAttribute){for(let De=0;De<K.locationSize;De++)g(K.location+De,_e.meshPerAttribute);V.isInstancedMesh!==!0&&U._maxInstanceCount===void 0&&(U._maxInstanceCount=_e.meshPerAttribute*_e.count)}else for(let De=0;De<K.locationSize;De++)p(K.location+De);i.bindBuffer(i.ARRAY_BUFFER,ne);for(let De=0;De<K.locationSize;De++)P(K.location+De,Re/K.locationSize,ve,le,Ue*Me,(dt+Re/K.locationSize*De)*Me,Pe)}else{if(oe.isInstancedBufferAttribute){for(let _e=0;_e<K.locationSize;_e++)g(K.location+_e,oe.meshPerAttribute);V.isInstancedMesh!==!0&&U._maxInstanceCount===void 0&&(U._maxInstanceCount=oe.meshPerAttribute*oe.count)}else for(let _e=0;_e<K.locationSize;_e++)p(K.location+_e);i.bindBuffer(i.ARRAY_BUFFER,ne);for(let _e=0;_e<K.locationSize;_e++)P(K.location+_e,Re/K.locationSize,ve,le,Re*Me,Re/K.locationSize*_e*Me,Pe)}}else if(Z!==void 0){let le=Z[he];if(le!==void 0)switch(le.length){case 2:i.vertexAttrib2fv(K.location,le);break;case 3:i.vertexAttrib3fv(K.location,le);break;case 4:i.vertexAttrib4fv(K.location,le);break;default:i.vertexAttrib1fv(K.location,le)}}}}S()}function I(){X();for(let V in n){let $=n[V];for(let Q in $){let U=$[Q];for(let J in U){let se=U[J];for(let Z in se)h(se[Z].object),delete se[Z];delete U[J]}}delete n[V]}}function R(V){if(n[V.id]===void 0)return;let $=n[V.id];for(let Q in $){let U=$[Q];for(let J in U){let se=U[J];for(let Z in se)h(se[Z].object),delete se[Z];delete U[J]}}delete n[V.id]}function y(V){for(let $ in n){let Q=n[$];for(let U in Q){let J=Q[U];if(J[V.id]===void 0)continue;let se=J[V.id];for(let Z in se)h(se[Z].object),delete se[Z];delete J[V.id]}}}function T(V){for(let $ in n){let Q=n[$],U=V.isInstancedMesh===!0?V.id:0,J=Q[U];if(J!==void 0){for(let se in J){let Z=J[se];for(let he in Z)h(Z[he].object),delete Z[he];delete J[se]}delete Q[U],Object.keys(Q).length===0&&delete n[$]}}}function X(){F(),a=!0,r!==s&&(r=s,c(r.object))}function F(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:o,reset:X,resetDefaultState:F,dispose:I,releaseStatesOfGeometry:R,releaseStatesOfObject:T,releaseStatesOfProgram:y,initAttributes:M,enableAttribute:p,disableUnusedAttributes:S}}function I_(i,e,t){let n;function s(l){n=l}function r(l,c){i.drawArrays(n,l,c),t.update(c,n,1)}function a(l,c,h){h!==0&&(i.drawArraysInstanced(n,l,c,h),t.update(c,n,h))}function o(l,c,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,l,0,c,0,h);let u=0;for(let f=0;f<h;f++)u+=c[f];t.update(u,n,1)}this.setMode=s,this.render=r,this.renderInstances=a,this.renderMultiDraw=o}function L_(i,e,t,n){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let y=e.get("EXT_texture_filter_anisotropic");s=i.getParameter(y.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function a(y){return!(y!==wn&&n.convert(y)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function o(y){let T=y===hn&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(y!==en&&y!==Sn&&!T&&n.convert(y)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE))}function l(y){if(y==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";y="mediump"}return y==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp",h=l(c);h!==c&&(Ne("WebGLRenderer:",c,"not supported, using",h,"instead."),c=h);let d=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),u=t.logarithmicDepthBuffer===!0&&d===!1;t.reversedDepthBuffer===!0&&d===!1&&Ne("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&d===!0&&Ne("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),_=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),M=i.getParameter(i.MAX_TEXTURE_SIZE),p=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),g=i.getParameter(i.MAX_VERTEX_ATTRIBS),S=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),P=i.getParameter(i.MAX_VARYING_VECTORS),w=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),I=i.getParameter(i.MAX_SAMPLES),R=i.getParameter(i.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:a,textureTypeReadable:o,precision:c,logarithmicDepthBuffer:u,reversedDepthBuffer:d,maxTextures:f,maxVertexTextures:_,maxTextureSize:M,maxCubemapSize:p,maxAttributes:g,maxVertexUniforms:S,maxVaryings:P,maxFragmentUniforms:w,maxSamples:I,samples:R}}function D_(i){let e=this,t=null,n=0,s=!1,r=!1,a=new an,o=new ze,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(d,u){let f=d.length!==0||u||n!==0||s;return s=u,n=d.length,f},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(d,u){t=h(d,u,0)},this.setState=function(d,u,f){let _=d.clippingPlanes,M=d.clipIntersection,p=d.clipShadows,g=i.get(d);if(!s||_===null||_.length===0||r&&!p)r?h(null):c();else{let S=r?0:n,P=S*4,w=g.clippingState||null;l.value=w,w=h(_,u,P,f);for(let I=0;I!==P;++I)w[I]=t[I];g.clippingState=w,this.numIntersection=M?this.numPlanes:0,this.numPlanes+=S}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=n>0),e.numPlanes=n,e.numIntersection=0}function h(d,u,f,_){let M=d!==null?d.length:0,p=null;if(M!==0){if(p=l.value,_!==!0||p===null){let g=f+M*4,S=u.matrixWorldInverse;o.getNormalMatrix(S),(p===null||p.length<g)&&(p=new Float32Array(g));for(let P=0,w=f;P!==M;++P,w+=4)a.copy(d[P]).applyMatrix4(S,o),a.normal.toArray(p,w),p[w+3]=a.constant}l.value=p,l.needsUpdate=!0}return e.numPlanes=M,e.numIntersection=0,p}}var Tr=class extends ln{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},s=[n,n,n,n,n,n];this.texture=new ar(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

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
			`},s=new ws(5,5,5),r=new Ln({name:"CubemapFromEquirect",uniforms:Hi(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Yt,blending:ki});r.uniforms.tEquirect.value=t;let a=new qt(s,r),o=t.minFilter;return t.minFilter===ei&&(t.minFilter=wt),new As(1,10,this).update(e,a),t.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,s=!0){let r=e.getRenderTarget();for(let a=0;a<6;a++)e.setRenderTarget(this,a),e.clear(t,n,s);e.setRenderTarget(r)}},Ed=256,N_=3,U_=20,$d=256,Zd=16,F_=3,O_=new z,B_=new Ge,Ns=class i{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new As(1,10,null),this._boxMesh=new qt(new ws(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,s=100,r={}){let{size:a=256,position:o=O_}=r,l=this._renderer;this._setSize(a);let c=this._allocateTarget(),h=this._getSourceTarget(!0);t>0&&(h.texture.mipmapsAutoUpdate=!1);let d=l.autoClear,u=l.autoClearColor,f=l.autoClearDepth,_=l.autoClearStencil,M=e.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,M===null&&(e.background=l.getClearColor(B_));let p=new As(n,s,h);return p.position.copy(o),p.update(l,e),l.autoClear=d,l.autoClearColor=u,l.autoClearDepth=f,l.autoClearStencil=_,e.background=M,t>0&&(h.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Rd(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Td(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(Ed,Ac(e))}_fromTexture(e,t){e.mapping===Vi||e.mapping===Cs?this._setSize(e.image.length===0?Ed:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=Ad(e,!1,!1),n=Math.log2(e)-N_;for(let s=0;s<=n;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Ad(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let s=this._boxMesh,r=this._cubeCamera;s.material=n,r.renderTarget=e,r.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),r.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===Vi||e.mapping===Cs?(this._cubemapMaterial===null&&(this._cubemapMaterial=Rd()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Td()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=k_(),this._integrationMaterial=z_());let t=this._cubeSize,n=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(t/Zd);for(let a=0;a<=n;a++){let o=i.lodToRoughness(a,n);if(a>n-F_)r.roughness.value=o,this._renderCube(e,a,this._integrationMaterial);else{let l=o>0?Math.log2(t)+.5*Math.log2(6/($d*Math.pow(o,4)))+.5:0;s.roughness.value=o,s.lodBias.value=l,this._renderCube(e,a,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=V_());let n=this._blurMaterial,s=n.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(e,0,n),s.envMap.value=e.texture,this._renderCube(r,0,n)}};function Ad(i,e,t){return new Tr(i,{minFilter:ei,generateMipmaps:e,type:hn,colorSpace:Js,depthBuffer:t})}function Rr(i,e,t){return new Ln({name:i,uniforms:e,vertexShader:He.cube_vert,fragmentShader:t,side:Yt,blending:ki,depthTest:!1,depthWrite:!1})}function k_(){return Rr("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${$d}u

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
	`)}function z_(){return Rr("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Zd}},`

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
	`)}function V_(){return Rr("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${U_}
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
	`)}function Td(){return Rr("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

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
	`)}function Rd(){return Rr("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function G_(i){let e=new WeakMap,t=new WeakMap,n=null;function s(u,f=!1){return u==null?null:f?a(u):r(u)}function r(u){if(u&&u.isTexture){let f=u.mapping;if(f===Ps||f===ao)if(e.has(u)){let _=e.get(u).texture;return o(_,u.mapping)}else{let _=u.image;if(_&&_.height>0){let M=new Tr(_.height);return M.fromEquirectangularTexture(i,u),e.set(u,M),u.addEventListener("dispose",c),o(M.texture,u.mapping)}else return null}}return u}function a(u){if(u&&u.isTexture&&u.isPMREMTexture!==!0){let f=u.mapping,_=f===Ps||f===ao,M=f===Vi||f===Cs;if(_||M){let p=t.get(u),g=p!==void 0?p.texture.pmremVersion:0;if(u.isRenderTargetTexture&&u.pmremVersion!==g)return n===null&&(n=new Ns(i)),p=_?n.fromEquirectangular(u,p):n.fromCubemap(u,p),p.texture.pmremVersion=u.pmremVersion,t.set(u,p),p.texture;if(p!==void 0)return p.texture;{let S=u.image;return _&&S&&S.height>0||M&&S&&l(S)?(n===null&&(n=new Ns(i)),p=_?n.fromEquirectangular(u):n.fromCubemap(u),p.texture.pmremVersion=u.pmremVersion,t.set(u,p),u.addEventListener("dispose",h),p.texture):null}}}return u}function o(u,f){return f===Ps?u.mapping=Vi:f===ao&&(u.mapping=Cs),u}function l(u){let f=0,_=6;for(let M=0;M<_;M++)u[M]!==void 0&&f++;return f===_}function c(u){let f=u.target;f.removeEventListener("dispose",c);let _=e.get(f);_!==void 0&&(e.delete(f),_.dispose())}function h(u){let f=u.target;f.removeEventListener("dispose",h);let _=t.get(f);_!==void 0&&(t.delete(f),_.dispose())}function d(){e=new WeakMap,t=new WeakMap,n!==null&&(n.dispose(),n=null)}return{get:s,dispose:d}}function H_(i){let e={};function t(n){if(e[n]!==void 0)return e[n];let s=i.getExtension(n);return e[n]=s,s}return{has:function(n){return t(n)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(n){let s=t(n);return s===null&&Ys("WebGLRenderer: "+n+" extension not supported."),s}}}function W_(i,e,t,n){let s={},r=new WeakMap,a=new FinalizationRegistry(_=>delete s[_]);function o(_){l(_.target)}function l(_){_.index!==null&&e.remove(_.index);for(let p in _.attributes)e.remove(_.attributes[p]);_.removeEventListener("dispose",o),delete s[_.id],a.unregister(_);let M=r.get(_);M&&(e.remove(M),r.delete(_)),n.releaseStatesOfGeometry(_),_.isInstancedBufferGeometry===!0&&delete _._maxInstanceCount,t.memory.geometries--}function c(_,M){return s[M.id]!==void 0||(M.addEventListener("dispose",o),s[M.id]=new WeakRef(M),a.register(M,M.id,M),t.memory.geometries++),M}function h(_){let M=_.attributes;for(let p in M)e.update(M[p],i.ARRAY_BUFFER)}function d(_){let M=_.index,p=_.attributes.position,g=0;if(p===void 0)return;let S=M!==null?M.array.length:p.array.length/3-1,P=p.count>=65535?rr:sr,w=new P(Math.ceil(S/3)*6,1),I=w.array;if(M!==null){let y=M.array;g=M.version;for(let T=0,X=0;T<S;T+=3){let F=y[T+0],V=y[T+1],$=y[T+2];I[X++]=F,I[X++]=V,I[X++]=V,I[X++]=$,I[X++]=$,I[X++]=F}}else{g=p.version;for(let y=0,T=0;y<S;y+=3){let X=y+0,F=y+1,V=y+2;I[T++]=X,I[T++]=F,I[T++]=F,I[T++]=V,I[T++]=V,I[T++]=X}}w.version=g;let R=r.get(_);R&&e.remove(R),r.set(_,w)}function u(_){let M=r.get(_);if(M){let p=_.index;p!==null&&M.version<p.version&&d(_)}else d(_);return r.get(_)}function f(){for(let _ in s){let M=s[_].deref();M!==void 0&&l(M)}}return{get:c,update:h,getWireframeAttribute:u,dispose:f}}function X_(i,e,t){let n;function s(d){n=d}let r,a;function o(d){r=d.type,a=d.bytesPerElement}function l(d,u){i.drawElements(n,u,r,d*a),t.update(u,n,1)}function c(d,u,f){f!==0&&(i.drawElementsInstanced(n,u,r,d*a,f),t.update(u,n,f))}function h(d,u,f){if(f===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,u,0,r,d,0,f);let M=0;for(let p=0;p<f;p++)M+=u[p];t.update(M,n,1)}this.setMode=s,this.setIndex=o,this.render=l,this.renderInstances=c,this.renderMultiDraw=h}function q_(i){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,a,o){switch(t.calls++,a){case i.TRIANGLES:t.triangles+=o*(r/3);break;case i.LINES:t.lines+=o*(r/2);break;case i.LINE_STRIP:t.lines+=o*(r-1);break;case i.LINE_LOOP:t.lines+=o*r;break;case i.POINTS:t.points+=o*r;break;default:Oe("WebGLInfo: Unknown draw mode:",a);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:n}}function Y_(i,e,t){let n=new WeakMap,s=new gt;function r(a,o,l){let c=a.morphTargetInfluences,h=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,d=h!==void 0?h.length:0,u=n.get(o);if(u===void 0||u.count!==d){let X=function(){y.dispose(),n.delete(o),o.removeEventListener("dispose",X)};u!==void 0&&u.texture.dispose();let f=o.morphAttributes.position!==void 0,_=o.morphAttributes.normal!==void 0,M=o.morphAttributes.color!==void 0,p=o.morphAttributes.position||[],g=o.morphAttributes.normal||[],S=o.morphAttributes.color||[],P=0;f===!0&&(P=1),_===!0&&(P=2),M===!0&&(P=3);let w=o.attributes.position.count*P,I=1;w>e.maxTextureSize&&(I=Math.ceil(w/e.maxTextureSize),w=e.maxTextureSize);let R=new Float32Array(w*I*4*d),y=new er(R,w,I,d);y.type=Sn,y.needsUpdate=!0;let T=P*4;for(let F=0;F<d;F++){let V=p[F],$=g[F],Q=S[F],U=w*I*4*F;for(let J=0;J<V.count;J++){let se=J*T;f===!0&&(s.fromBufferAttribute(V,J),R[U+se+0]=s.x,R[U+se+1]=s.y,R[U+se+2]=s.z,R[U+se+3]=0),_===!0&&(s.fromBufferAttribute($,J),R[U+se+4]=s.x,R[U+se+5]=s.y,R[U+se+6]=s.z,R[U+se+7]=0),M===!0&&(s.fromBufferAttribute(Q,J),R[U+se+8]=s.x,R[U+se+9]=s.y,R[U+se+10]=s.z,R[U+se+11]=Q.itemSize===4?s.w:1)}}u={count:d,texture:y,size:new Be(w,I)},n.set(o,u),o.addEventListener("dispose",X)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",a.morphTexture,t);else{let f=0;for(let M=0;M<c.length;M++)f+=c[M];let _=o.morphTargetsRelative?1:1-f;l.getUniforms().setValue(i,"morphTargetBaseInfluence",_),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",u.texture,t),l.getUniforms().setValue(i,"morphTargetsTextureSize",u.size)}return{update:r}}function $_(i,e,t,n,s){let r=new WeakMap;function a(c){let h=s.render.frame,d=c.geometry,u=e.get(c,d);if(r.get(u)!==h&&(e.update(u),r.set(u,h)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==h&&(t.update(c.instanceMatrix,i.ARRAY_BUFFER),c.instanceColor!==null&&t.update(c.instanceColor,i.ARRAY_BUFFER),r.set(c,h))),c.isSkinnedMesh){let f=c.skeleton;r.get(f)!==h&&(f.update(),r.set(f,h))}return u}function o(){r=new WeakMap}function l(c){let h=c.target;h.removeEventListener("dispose",l),n.releaseStatesOfObject(h),t.remove(h.instanceMatrix),h.instanceColor!==null&&t.remove(h.instanceColor)}return{update:a,dispose:o}}var Z_={[ac]:"LINEAR_TONE_MAPPING",[oc]:"REINHARD_TONE_MAPPING",[lc]:"CINEON_TONE_MAPPING",[cc]:"ACES_FILMIC_TONE_MAPPING",[uc]:"AGX_TONE_MAPPING",[_r]:"NEUTRAL_TONE_MAPPING",[hc]:"CUSTOM_TONE_MAPPING"};function K_(i,e,t,n,s,r){let a=new ln(e,t,{type:i,depthBuffer:s,stencilBuffer:r,samples:n?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),o=null,l=null,c=null,h=new In;h.setAttribute("position",new mn([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new mn([0,2,0,0,2,0],2));let d=new Xa({uniforms:{tDiffuse:{value:null}},vertexShader:`
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
			}`,depthTest:!1,depthWrite:!1}),u=new qt(h,d),f=new dr(-1,1,1,-1,0,1),_=null,M=null,p=!1,g,S=null,P=[],w=!1;this.setSize=function(I,R){a.setSize(I,R),o!==null&&o.setSize(I,R),l!==null&&l.setSize(I,R);for(let y=0;y<P.length;y++){let T=P[y];T.setSize&&T.setSize(I,R)}},this.setEffects=function(I){P=I,w=P.length>0&&P[0].isRenderPass===!0;let R=a.width,y=a.height;P.length>0&&o===null&&(o=new ln(R,y,{type:hn,depthBuffer:!1,stencilBuffer:!1}),l=new ln(R,y,{type:hn,depthBuffer:!1,stencilBuffer:!1}));let T=s===!0&&P.some(X=>X.needsDepthTexture===!0);T!==(a.depthTexture!==null)&&(T===!0&&c===null&&(c=new Qn(R,y),r===!0&&(c.format=ti,c.type=Gi)),a.dispose(),a.depthTexture=T?c:null,a.resolveDepthBuffer=T,a.storeMultisampledDepthBuffer=T);for(let X=0;X<P.length;X++){let F=P[X];F.setSize&&F.setSize(R,y),T&&F.needsDepthTexture===!0&&F.setDepthTexture&&F.setDepthTexture(c)}},this.begin=function(I,R){if(p||I.toneMapping===Un&&P.length===0)return!1;if(S=R,R!==null){let y=R.width,T=R.height;(a.width!==y||a.height!==T)&&this.setSize(y,T)}return w===!1&&I.setRenderTarget(a),g=I.toneMapping,I.toneMapping=Un,!0},this.hasRenderPass=function(){return w},this.end=function(I,R){I.toneMapping=g,p=!0;let y=a,T=o;for(let X=0;X<P.length;X++){let F=P[X];F.enabled!==!1&&(F.render(I,T,y,R),F.needsSwap!==!1&&(y=T,T=T===o?l:o))}if(_!==I.outputColorSpace||M!==I.toneMapping){_=I.outputColorSpace,M=I.toneMapping,d.defines={},Ke.getTransfer(_)===st&&(d.defines.SRGB_TRANSFER="");let X=Z_[M];X&&(d.defines[X]=""),d.needsUpdate=!0}d.uniforms.tDiffuse.value=y.texture,I.setRenderTarget(S),I.render(u,f),S=null,p=!1},this.isCompositing=function(){return p},this.dispose=function(){a.dispose(),o!==null&&o.dispose(),l!==null&&l.dispose(),h.dispose(),d.dispose()}}var Kd=new zt,Jd=new Qn(1,1),jd=new or(1),Qd=new er,ef=new Ha,tf=new ar,Cd=[],Pd=[],Id=new Float32Array(16),Ld=new Float32Array(9),Dd=new Float32Array(4);function Us(i,e,t){let n=i[0];if(n<=0||n>0)return i;let s=e*t,r=Cd[s];if(r===void 0&&(r=new Float32Array(s),Cd[s]=r),e!==0){n.toArray(r,0);for(let a=1,o=0;a!==e;++a)o+=t,i[a].toArray(r,o)}return r}function At(i,e){if(i.length!==e.length)return!1;for(let t=0,n=i.length;t<n;t++)if(i[t]!==e[t])return!1;return!0}function Tt(i,e){for(let t=0,n=e.length;t<n;t++)i[t]=e[t]}function Zo(i,e){let t=Pd[e];t===void 0&&(t=new Int32Array(e),Pd[e]=t);for(let n=0;n!==e;++n)t[n]=i.allocateTextureUnit();return t}function J_(i,e){let t=this.cache;t[0]!==e&&(i.uniform1f(this.addr,e),t[0]=e)}function j_(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(At(t,e))return;i.uniform2fv(this.addr,e),Tt(t,e)}}function Q_(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(i.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(At(t,e))return;i.uniform3fv(this.addr,e),Tt(t,e)}}function ey(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(At(t,e))return;i.uniform4fv(this.addr,e),Tt(t,e)}}function ty(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(At(t,e))return;i.uniformMatrix2fv(this.addr,!1,e),Tt(t,e)}else{if(At(t,n))return;Dd.set(n),i.uniformMatrix2fv(this.addr,!1,Dd),Tt(t,n)}}function ny(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(At(t,e))return;i.uniformMatrix3fv(this.addr,!1,e),Tt(t,e)}else{if(At(t,n))return;Ld.set(n),i.uniformMatrix3fv(this.addr,!1,Ld),Tt(t,n)}}function iy(i,e){let t=this.cache,n=e.elements;if(n===void 0){if(At(t,e))return;i.uniformMatrix4fv(this.addr,!1,e),Tt(t,e)}else{if(At(t,n))return;Id.set(n),i.uniformMatrix4fv(this.addr,!1,Id),Tt(t,n)}}function sy(i,e){let t=this.cache;t[0]!==e&&(i.uniform1i(this.addr,e),t[0]=e)}function ry(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(At(t,e))return;i.uniform2iv(this.addr,e),Tt(t,e)}}function ay(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(At(t,e))return;i.uniform3iv(this.addr,e),Tt(t,e)}}function oy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(At(t,e))return;i.uniform4iv(this.addr,e),Tt(t,e)}}function ly(i,e){let t=this.cache;t[0]!==e&&(i.uniform1ui(this.addr,e),t[0]=e)}function cy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(i.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(At(t,e))return;i.uniform2uiv(this.addr,e),Tt(t,e)}}function hy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(i.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(At(t,e))return;i.uniform3uiv(this.addr,e),Tt(t,e)}}function uy(i,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(i.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(At(t,e))return;i.uniform4uiv(this.addr,e),Tt(t,e)}}function Ko(i){return i.version===0&&(i.compareFunction=Mc,i.needsUpdate=!0),i}function dy(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?r=Ko(Jd):r=Kd,t.setTexture2D(e||r,s)}function fy(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture3D(e||ef,s)}function py(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_CUBE_SHADOW?r=Ko(jd):r=tf,t.setTextureCube(e||r,s)}function my(i,e,t){let n=this.cache,s=t.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),t.setTexture2DArray(e||Qd,s)}function gy(i){switch(i){case 5126:return J_;case 35664:return j_;case 35665:return Q_;case 35666:return ey;case 35674:return ty;case 35675:return ny;case 35676:return iy;case 5124:case 35670:return sy;case 35667:case 35671:return ry;case 35668:case 35672:return ay;case 35669:case 35673:return oy;case 5125:return ly;case 36294:return cy;case 36295:return hy;case 36296:return uy;case 35678:case 36198:case 36298:case 36306:case 35682:return dy;case 35679:case 36299:case 36307:return fy;case 35680:case 36300:case 36308:case 36293:return py;case 36289:case 36303:case 36311:case 36292:return my}}function _y(i,e){i.uniform1fv(this.addr,e)}function yy(i,e){let t=Us(e,this.size,2);i.uniform2fv(this.addr,t)}function vy(i,e){let t=Us(e,this.size,3);i.uniform3fv(this.addr,t)}function xy(i,e){let t=Us(e,this.size,4);i.uniform4fv(this.addr,t)}function by(i,e){let t=Us(e,this.size,4);i.uniformMatrix2fv(this.addr,!1,t)}function My(i,e){let t=Us(e,this.size,9);i.uniformMatrix3fv(this.addr,!1,t)}function Sy(i,e){let t=Us(e,this.size,16);i.uniformMatrix4fv(this.addr,!1,t)}function wy(i,e){i.uniform1iv(this.addr,e)}function Ey(i,e){i.uniform2iv(this.addr,e)}function Ay(i,e){i.uniform3iv(this.addr,e)}function Ty(i,e){i.uniform4iv(this.addr,e)}function Ry(i,e){i.uniform1uiv(this.addr,e)}function Cy(i,e){i.uniform2uiv(this.addr,e)}function Py(i,e){i.uniform3uiv(this.addr,e)}function Iy(i,e){i.uniform4uiv(this.addr,e)}function Ly(i,e,t){let n=this.cache,s=e.length,r=Zo(t,s);At(n,r)||(i.uniform1iv(this.addr,r),Tt(n,r));let a;this.type===i.SAMPLER_2D_SHADOW?a=Ko(Jd):a=Kd;for(let o=0;o!==s;++o)t.setTexture2D(e[o]||a,r[o])}function Dy(i,e,t){let n=this.cache,s=e.length,r=Zo(t,s);At(n,r)||(i.uniform1iv(this.addr,r),Tt(n,r));for(let a=0;a!==s;++a)t.setTexture3D(e[a]||ef,r[a])}function Ny(i,e,t){let n=this.cache,s=e.length,r=Zo(t,s);At(n,r)||(i.uniform1iv(this.addr,r),Tt(n,r));let a;this.type===i.SAMPLER_CUBE_SHADOW?a=Ko(jd):a=tf;for(let o=0;o!==s;++o)t.setTextureCube(e[o]||a,r[o])}function Uy(i,e,t){let n=this.cache,s=e.length,r=Zo(t,s);At(n,r)||(i.uniform1iv(this.addr,r),Tt(n,r));for(let a=0;a!==s;++a)t.setTexture2DArray(e[a]||Qd,r[a])}function Fy(i){switch(i){case 5126:return _y;case 35664:return yy;case 35665:return vy;case 35666:return xy;case 35674:return by;case 35675:return My;case 35676:return Sy;case 5124:case 35670:return wy;case 35667:case 35671:return Ey;case 35668:case 35672:return Ay;case 35669:case 35673:return Ty;case 5125:return Ry;case 36294:return Cy;case 36295:return Py;case 36296:return Iy;case 35678:case 36198:case 36298:case 36306:case 35682:return Ly;case 35679:case 36299:case 36307:return Dy;case 35680:case 36300:case 36308:case 36293:return Ny;case 36289:case 36303:case 36311:case 36292:return Uy}}var Nc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=gy(t.type)}},Uc=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=Fy(t.type)}},Fc=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let s=this.seq;for(let r=0,a=s.length;r!==a;++r){let o=s[r];o.setValue(e,t[o.id],n)}}},Lc=/(\w+)(\])?(\[|\.)?/g;function Nd(i,e){i.seq.push(e),i.map[e.id]=e}function Oy(i,e,t){let n=i.name,s=n.length;for(Lc.lastIndex=0;;){let r=Lc.exec(n),a=Lc.lastIndex,o=r[1],l=r[2]==="]",c=r[3];if(l&&(o=o|0),c===void 0||c==="["&&a+2===s){Nd(t,c===void 0?new Nc(o,i,e):new Uc(o,i,e));break}else{let d=t.map[o];d===void 0&&(d=new Fc(o),Nd(t,d)),t=d}}}var Ds=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let a=0;a<n;++a){let o=e.getActiveUniform(t,a),l=e.getUniformLocation(t,o.name);Oy(o,l,this)}let s=[],r=[];for(let a of this.seq)a.type===e.SAMPLER_2D_SHADOW||a.type===e.SAMPLER_CUBE_SHADOW||a.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(a):r.push(a);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,n,s){let r=this.map[t];r!==void 0&&r.setValue(e,n,s)}setOptional(e,t,n){let s=t[n];s!==void 0&&this.setValue(e,n,s)}static upload(e,t,n,s){for(let r=0,a=t.length;r!==a;++r){let o=t[r],l=n[o.id];l.needsUpdate!==!1&&o.setValue(e,l.value,s)}}static seqWithValue(e,t){let n=[];for(let s=0,r=e.length;s!==r;++s){let a=e[s];a.id in t&&n.push(a)}return n}};function Ud(i,e,t){let n=i.createShader(e);return i.shaderSource(n,t),i.compileShader(n),n}var By=37297,ky=0;function zy(i,e){let t=i.split(`
`),n=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let a=s;a<r;a++){let o=a+1;n.push(`${o===e?">":" "} ${o}: ${t[a]}`)}return n.join(`
`)}var Fd=new ze;function Vy(i){Ke._getMatrix(Fd,Ke.workingColorSpace,i);let e=`mat3( ${Fd.elements.map(t=>t.toFixed(4))} )`;switch(Ke.getTransfer(i)){case js:return[e,"LinearTransferOETF"];case st:return[e,"sRGBTransferOETF"];default:return Ne("WebGLProgram: Unsupported color space: ",i),[e,"LinearTransferOETF"]}}function Od(i,e,t){let n=i.getShaderParameter(e,i.COMPILE_STATUS),r=(i.getShaderInfoLog(e)||"").trim();if(n&&r==="")return"";let a=/ERROR: 0:(\d+)/.exec(r);if(a){let o=parseInt(a[1]);return t.toUpperCase()+`

`+r+`

`+zy(i.getShaderSource(e),o)}else return r}function Gy(i,e){let t=Vy(e);return[`vec4 ${i}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var Hy={[ac]:"Linear",[oc]:"Reinhard",[lc]:"Cineon",[cc]:"ACESFilmic",[uc]:"AgX",[_r]:"Neutral",[hc]:"Custom"};function Wy(i,e){let t=Hy[e];return t===void 0?(Ne("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+i+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+i+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var Yo=new z;function Xy(){Ke.getLuminanceCoefficients(Yo);let i=Yo.x.toFixed(4),e=Yo.y.toFixed(4),t=Yo.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function qy(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Ar).join(`
`)}function Yy(i){let e=[];for(let t in i){let n=i[t];n!==!1&&e.push("#define "+t+" "+n)}return e.join(`
`)}function $y(i,e){let t={},n=i.getProgramParameter(e,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(e,s),a=r.name,o=1;r.type===i.FLOAT_MAT2&&(o=2),r.type===i.FLOAT_MAT3&&(o=3),r.type===i.FLOAT_MAT4&&(o=4),t[a]={type:r.type,location:i.getAttribLocation(e,a),locationSize:o}}return t}function Ar(i){return i!==""}function Bd(i,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return i.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function kd(i,e){return i.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var Zy=/^[ \t]*#include +<([\w\d./]+)>/gm;function Oc(i){return i.replace(Zy,Ky)}function Ky(i,e){let t=He[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Oc(t)}var Jy=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function zd(i){return i.replace(Jy,jy)}function jy(i,e,t,n){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function Vd(i){let e=`precision ${i.precision} float;
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
#define LOW_PRECISION`),e}var Qy={[gr]:"SHADOWMAP_TYPE_PCF",[Ts]:"SHADOWMAP_TYPE_VSM"};function ev(i){return Qy[i.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var tv={[Cs]:"ENVMAP_MODE_REFRACTION"};function nv(i){return i.envMap===!1?"ENVMAP_MODE_REFLECTION":tv[i.envMapMode]||"ENVMAP_MODE_REFLECTION"}var iv={[rc]:"ENVMAP_BLENDING_MULTIPLY",[id]:"ENVMAP_BLENDING_MIX",[sd]:"ENVMAP_BLENDING_ADD"};function sv(i){return i.envMap===!1?"ENVMAP_BLENDING_NONE":iv[i.combine]||"ENVMAP_BLENDING_NONE"}function rv(i,e,t,n){let s=i.getContext(),r=t.defines,a=t.vertexShader,o=t.fragmentShader,l=ev(t),c=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=nv(t),d=sv(t),u=qy(t),f=Yy(r),_=s.createProgram(),M,p,g=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(M=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Ar).join(`
`),M.length>0&&(M+=`
`),p=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Ar).join(`
`),p.length>0&&(p+=`
`)):(M=[Vd(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+h:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Ar).join(`
`),p=[Vd(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+h:"",t.envMap?"#define "+d:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==Un?"#define TONE_MAPPING":"",t.toneMapping!==Un?He.tonemapping_pars_fragment:"",t.toneMapping!==Un?Wy("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",He.colorspace_pars_fragment,Gy("linearToOutputTexel",t.outputColorSpace),Xy(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(Ar).join(`
`)),a=Oc(a),a=Bd(a,t),a=kd(a,t),o=Oc(o),o=Bd(o,t),o=kd(o,t),a=zd(a),o=zd(o),t.isRawShaderMaterial!==!0&&(g=`#version 300 es
`,M=[u,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+M,p=["#define varying in",t.glslVersion===Sc?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===Sc?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+p);let S=g+M+a,P=g+p+o,w=Ud(s,s.VERTEX_SHADER,S),I=Ud(s,s.FRAGMENT_SHADER,P);s.attachShader(_,w),s.attachShader(_,I),t.index0AttributeName!==void 0?s.bindAttribLocation(_,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(_,0,"position"),s.linkProgram(_);function R(F){if(i.debug.checkShaderErrors){let V=s.getProgramInfoLog(_)||"",$=s.getShaderInfoLog(w)||"",Q=s.getShaderInfoLog(I)||"",U=V.trim(),J=$.trim(),se=Q.trim(),Z=!0,he=!0;if(s.getProgramParameter(_,s.LINK_STATUS)===!1)if(Z=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,_,w,I);else{let K=Od(s,w,"vertex"),oe=Od(s,I,"fragment");Oe("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(_,s.VALIDATE_STATUS)+`

Material Name: `+F.name+`
Material Type: `+F.type+`

Program Info Log: `+U+`
`+K+`
`+oe)}else U!==""?Ne("WebGLProgram: Program Info Log:",U):(J===""||se==="")&&(he=!1);he&&(F.diagnostics={runnable:Z,programLog:U,vertexShader:{log:J,prefix:M},fragmentShader:{log:se,prefix:p}})}s.deleteShader(w),s.deleteShader(I),y=new Ds(s,_),T=$y(s,_)}let y;this.getUniforms=function(){return y===void 0&&R(this),y};let T;this.getAttributes=function(){return T===void 0&&R(this),T};let X=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return X===!1&&(X=s.getProgramParameter(_,By)),X},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(_),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=ky++,this.cacheKey=e,this.usedTimes=1,this.program=_,this.vertexShader=w,this.fragmentShader=I,this}var av=0,Bc=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(n)===!1&&(s.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let n of t)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new kc(e),t.set(e,n)),n}},kc=class{constructor(e){this.id=av++,this.code=e,this.usedTimes=0}};function ov(i){return i===Mi||i===Sr||i===wr}function lv(i,e,t,n,s,r){let a=new tr,o=new Bc,l=new Set,c=[],h=new Map,d=n.logarithmicDepthBuffer,u={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(y){return l.add(y),y===0?"uv":`uv${y}`}function _(y,T,X,F,V,$){let Q=F.fog,U=V.geometry,J=y.isMeshStandardMaterial||y.isMeshLambertMaterial||y.isMeshPhongMaterial?F.environment:null,se=y.isMeshStandardMaterial||y.isMeshLambertMaterial&&!y.envMap||y.isMeshPhongMaterial&&!y.envMap,Z=e.get(y.envMap||J,se),he=u[y.type],K=n.precision;y.precision!==null&&(K=n.getMaxPrecision(y.precision),K!==y.precision&&Ne("WebGLProgram.getParameters:",y.precision,"not supported, using",K,"instead."));let oe=U.morphAttributes.position||U.morphAttributes.normal||U.morphAttributes.color,le=oe!==void 0?oe.length:0,Re=0;U.morphAttributes.position!==void 0&&(Re=1),U.morphAttributes.normal!==void 0&&(Re=2),U.morphAttributes.color!==void 0&&(Re=3);let ke,ne,ve,Me;if(he){let te=Bn[he];ke=te.vertexShader,ne=te.fragmentShader}else{ke=y.vertexShader,ne=y.fragmentShader;let te=o.getVertexShaderStage(y),ue=o.getFragmentShaderStage(y);o.update(y,te,ue),ve=te.id,Me=ue.id}let Pe=i.getRenderTarget(),_e=i.state.buffers.depth.getReversed(),Ue=V.isInstancedMesh===!0,dt=V.isBatchedMesh===!0,De=!!y.map,je=!!y.matcap,nt=!!Z,Xe=nt&&Z.isPMREMTexture===!0,Et=!!y.aoMap,vt=!!y.lightMap,Lt=!!y.bumpMap&&y.wireframe===!1,at=!!y.normalMap,un=!!y.displacementMap,pt=!!y.emissiveMap,$t=!!y.metalnessMap,Zt=!!y.roughnessMap,Kt=y.anisotropy>0,O=y.clearcoat>0,Jt=y.diffuseRoughness>0,ot=y.dispersion>0,lt=y.retroreflectivity>0,ye=y.iridescence>0,_t=y.sheen>0,Le=y.transmission>0,Fe=Kt&&!!y.anisotropyMap,A=O&&!!y.clearcoatMap,v=O&&!!y.clearcoatNormalMap,G=O&&!!y.clearcoatRoughnessMap,ce=Jt&&!!y.diffuseRoughnessMap,re=ye&&!!y.iridescenceMap,de=ye&&!!y.iridescenceThicknessMap,pe=_t&&!!y.sheenColorMap,j=_t&&!!y.sheenRoughnessMap,ee=!!y.specularMap,fe=!!y.specularColorMap,L=!!y.specularIntensityMap,ie=Le&&!!y.transmissionMap,m=Le&&!!y.thicknessMap,b=!!y.gradientMap,E=!!y.alphaMap,C=y.alphaTest>0,D=!!y.alphaHash,k=!!y.extensions,B=Un;y.toneMapped&&(Pe===null||Pe.isXRRenderTarget===!0)&&(B=i.toneMapping);let q=Xe?Z.isCompressedCubeTexture?Z.image[0].mipmaps:Z.mipmaps:null,ae={shaderID:he,shaderType:y.type,shaderName:y.name,vertexShader:ke,fragmentShader:ne,defines:y.defines,customVertexShaderID:ve,customFragmentShaderID:Me,isRawShaderMaterial:y.isRawShaderMaterial===!0,glslVersion:y.glslVersion,precision:K,batching:dt,batchingColor:dt&&V._colorsTexture!==null,instancing:Ue,instancingColor:Ue&&V.instanceColor!==null,instancingMorph:Ue&&V.morphTexture!==null,outputColorSpace:Pe===null?i.outputColorSpace:Pe.isXRRenderTarget===!0?Pe.texture.colorSpace:Ke.workingColorSpace,alphaToCoverage:!!y.alphaToCoverage,map:De,matcap:je,envMap:nt,envMapMode:nt&&Z.mapping,envMapPMREM:Xe,envMapMaxLod:Xe?q.length-1:null,envMapSize:Xe?q[0].width:null,aoMap:Et,lightMap:vt,bumpMap:Lt,normalMap:at,displacementMap:un,emissiveMap:pt,normalMapObjectSpace:at&&y.normalMapType===od,normalMapTangentSpace:at&&y.normalMapType===Xo,packedNormalMap:at&&y.normalMapType===Xo&&ov(y.normalMap.format),metalnessMap:$t,roughnessMap:Zt,anisotropy:Kt,anisotropyMap:Fe,clearcoat:O,clearcoatMap:A,clearcoatNormalMap:v,clearcoatRoughnessMap:G,diffuseRoughness:Jt,diffuseRoughnessMap:ce,dispersion:ot,retroreflection:lt,iridescence:ye,iridescenceMap:re,iridescenceThicknessMap:de,sheen:_t,sheenColorMap:pe,sheenRoughnessMap:j,specularMap:ee,specularColorMap:fe,specularIntensityMap:L,transmission:Le,transmissionMap:ie,thicknessMap:m,gradientMap:b,opaque:y.transparent===!1&&y.blending===Rs&&y.alphaToCoverage===!1,alphaMap:E,alphaTest:C,alphaHash:D,combine:y.combine,mapUv:De&&f(y.map.channel),aoMapUv:Et&&f(y.aoMap.channel),lightMapUv:vt&&f(y.lightMap.channel),bumpMapUv:Lt&&f(y.bumpMap.channel),normalMapUv:at&&f(y.normalMap.channel),displacementMapUv:un&&f(y.displacementMap.channel),emissiveMapUv:pt&&f(y.emissiveMap.channel),metalnessMapUv:$t&&f(y.metalnessMap.channel),roughnessMapUv:Zt&&f(y.roughnessMap.channel),anisotropyMapUv:Fe&&f(y.anisotropyMap.channel),clearcoatMapUv:A&&f(y.clearcoatMap.channel),clearcoatNormalMapUv:v&&f(y.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:G&&f(y.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:ce&&f(y.diffuseRoughnessMap.channel),iridescenceMapUv:re&&f(y.iridescenceMap.channel),iridescenceThicknessMapUv:de&&f(y.iridescenceThicknessMap.channel),sheenColorMapUv:pe&&f(y.sheenColorMap.channel),sheenRoughnessMapUv:j&&f(y.sheenRoughnessMap.channel),specularMapUv:ee&&f(y.specularMap.channel),specularColorMapUv:fe&&f(y.specularColorMap.channel),specularIntensityMapUv:L&&f(y.specularIntensityMap.channel),transmissionMapUv:ie&&f(y.transmissionMap.channel),thicknessMapUv:m&&f(y.thicknessMap.channel),alphaMapUv:E&&f(y.alphaMap.channel),vertexTangents:!!U.attributes.tangent&&(at||Kt),vertexNormals:!!U.attributes.normal,vertexColors:y.vertexColors,vertexAlphas:y.vertexColors===!0&&!!U.attributes.color&&U.attributes.color.itemSize===4,pointsUvs:V.isPoints===!0&&!!U.attributes.uv&&(De||E),fog:!!Q,useFog:y.fog===!0,fogExp2:!!Q&&Q.isFogExp2,flatShading:y.wireframe===!1&&(y.flatShading===!0||U.attributes.normal===void 0&&at===!1&&(y.isMeshLambertMaterial||y.isMeshPhongMaterial||y.isMeshStandardMaterial||y.isMeshPhysicalMaterial)),sizeAttenuation:y.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:_e,skinning:V.isSkinnedMesh===!0,hasPositionAttribute:U.attributes.position!==void 0,morphTargets:U.morphAttributes.position!==void 0,morphNormals:U.morphAttributes.normal!==void 0,morphColors:U.morphAttributes.color!==void 0,morphTargetsCount:le,morphTextureStride:Re,numSunLights:T.sun.length,numDirLights:T.directional.length,numPointLights:T.point.length,numSpotLights:T.spot.length,numSpotLightMaps:T.spotLightMap.length,numRectAreaLights:T.rectArea.length,numHemiLights:T.hemi.length,numSunLightShadows:T.sunShadowMap.length,numDirLightShadows:T.directionalShadowMap.length,numPointLightShadows:T.pointShadowMap.length,numSpotLightShadows:T.spotShadowMap.length,numSpotLightShadowsWithMaps:T.numSpotLightShadowsWithMaps,numLightProbes:T.numLightProbes,numLightProbeGrids:$.filter(te=>te.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:y.dithering,shadowMapEnabled:i.shadowMap.enabled&&X.length>0,shadowMapType:i.shadowMap.type,toneMapping:B,decodeVideoTexture:De&&y.map.isVideoTexture===!0&&Ke.getTransfer(y.map.colorSpace)===st,decodeVideoTextureEmissive:pt&&y.emissiveMap.isVideoTexture===!0&&Ke.getTransfer(y.emissiveMap.colorSpace)===st,premultipliedAlpha:y.premultipliedAlpha,doubleSided:y.side===Qt,flipSided:y.side===Yt,useDepthPacking:y.depthPacking>=0,depthPacking:y.depthPacking||0,index0AttributeName:y.index0AttributeName,extensionClipCullDistance:k&&y.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(k&&y.extensions.multiDraw===!0||dt)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:y.customProgramCacheKey()};return ae.vertexUv1s=l.has(1),ae.vertexUv2s=l.has(2),ae.vertexUv3s=l.has(3),l.clear(),ae}function M(y){let T=[];if(y.shaderID?T.push(y.shaderID):(T.push(y.customVertexShaderID),T.push(y.customFragmentShaderID)),y.defines!==void 0)for(let X in y.defines)T.push(X),T.push(y.defines[X]);return y.isRawShaderMaterial===!1&&(p(T,y),g(T,y),T.push(i.outputColorSpace)),T.push(y.customProgramCacheKey),T.join()}function p(y,T){y.push(T.precision),y.push(T.outputColorSpace),y.push(T.envMapMode),y.push(T.envMapPMREM),y.push(T.envMapMaxLod),y.push(T.envMapSize),y.push(T.mapUv),y.push(T.alphaMapUv),y.push(T.lightMapUv),y.push(T.aoMapUv),y.push(T.bumpMapUv),y.push(T.normalMapUv),y.push(T.displacementMapUv),y.push(T.emissiveMapUv),y.push(T.metalnessMapUv),y.push(T.roughnessMapUv),y.push(T.anisotropyMapUv),y.push(T.clearcoatMapUv),y.push(T.clearcoatNormalMapUv),y.push(T.clearcoatRoughnessMapUv),y.push(T.diffuseRoughnessMapUv),y.push(T.iridescenceMapUv),y.push(T.iridescenceThicknessMapUv),y.push(T.sheenColorMapUv),y.push(T.sheenRoughnessMapUv),y.push(T.specularMapUv),y.push(T.specularColorMapUv),y.push(T.specularIntensityMapUv),y.push(T.transmissionMapUv),y.push(T.thicknessMapUv),y.push(T.combine),y.push(T.fogExp2),y.push(T.sizeAttenuation),y.push(T.morphTargetsCount),y.push(T.numSunLights),y.push(T.numDirLights),y.push(T.numPointLights),y.push(T.numSpotLights),y.push(T.numSpotLightMaps),y.push(T.numHemiLights),y.push(T.numRectAreaLights),y.push(T.numSunLightShadows),y.push(T.numDirLightShadows),y.push(T.numPointLightShadows),y.push(T.numSpotLightShadows),y.push(T.numSpotLightShadowsWithMaps),y.push(T.numLightProbes),y.push(T.numLightProbeGrids),y.push(T.shadowMapType),y.push(T.toneMapping),y.push(T.numClippingPlanes),y.push(T.numClipIntersection),y.push(T.depthPacking)}function g(y,T){a.disableAll(),T.instancing&&a.enable(0),T.instancingColor&&a.enable(1),T.instancingMorph&&a.enable(2),T.matcap&&a.enable(3),T.envMap&&a.enable(4),T.normalMapObjectSpace&&a.enable(5),T.normalMapTangentSpace&&a.enable(6),T.clearcoat&&a.enable(7),T.iridescence&&a.enable(8),T.alphaTest&&a.enable(9),T.vertexColors&&a.enable(10),T.vertexAlphas&&a.enable(11),T.vertexUv1s&&a.enable(12),T.vertexUv2s&&a.enable(13),T.vertexUv3s&&a.enable(14),T.vertexTangents&&a.enable(15),T.anisotropy&&a.enable(16),T.alphaHash&&a.enable(17),T.batching&&a.enable(18),T.dispersion&&a.enable(19),T.retroreflection&&a.enable(24),T.diffuseRoughness&&a.enable(25),T.batchingColor&&a.enable(20),T.gradientMap&&a.enable(21),T.packedNormalMap&&a.enable(22),T.vertexNormals&&a.enable(23),y.push(a.mask),a.disableAll(),T.fog&&a.enable(0),T.useFog&&a.enable(1),T.flatShading&&a.enable(2),T.logarithmicDepthBuffer&&a.enable(3),T.reversedDepthBuffer&&a.enable(4),T.skinning&&a.enable(5),T.morphTargets&&a.enable(6),T.morphNormals&&a.enable(7),T.morphColors&&a.enable(8),T.premultipliedAlpha&&a.enable(9),T.shadowMapEnabled&&a.enable(10),T.doubleSided&&a.enable(11),T.flipSided&&a.enable(12),T.useDepthPacking&&a.enable(13),T.dithering&&a.enable(14),T.transmission&&a.enable(15),T.sheen&&a.enable(16),T.opaque&&a.enable(17),T.pointsUvs&&a.enable(18),T.decodeVideoTexture&&a.enable(19),T.decodeVideoTextureEmissive&&a.enable(20),T.alphaToCoverage&&a.enable(21),T.numLightProbeGrids>0&&a.enable(22),T.hasPositionAttribute&&a.enable(23),y.push(a.mask)}function S(y){let T=u[y.type],X;if(T){let F=Bn[T];X=Md.clone(F.uniforms)}else X=y.uniforms;return X}function P(y,T){let X=h.get(T);return X!==void 0?++X.usedTimes:(X=new rv(i,T,y,s),c.push(X),h.set(T,X)),X}function w(y){if(--y.usedTimes===0){let T=c.indexOf(y);c[T]=c[c.length-1],c.pop(),h.delete(y.cacheKey),y.destroy()}}function I(y){o.remove(y)}function R(){o.dispose()}return{getParameters:_,getProgramCacheKey:M,getUniforms:S,acquireProgram:P,releaseProgram:w,releaseShaderCache:I,programs:c,dispose:R}}function cv(){let i=new WeakMap;function e(a){return i.has(a)}function t(a){let o=i.get(a);return o===void 0&&(o={},i.set(a,o)),o}function n(a){i.delete(a)}function s(a,o,l){i.get(a)[o]=l}function r(){i=new WeakMap}return{has:e,get:t,remove:n,update:s,dispose:r}}function hv(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.material.id!==e.material.id?i.material.id-e.material.id:i.materialVariant!==e.materialVariant?i.materialVariant-e.materialVariant:i.z!==e.z?i.z-e.z:i.id-e.id}function Gd(i,e){return i.groupOrder!==e.groupOrder?i.groupOrder-e.groupOrder:i.renderOrder!==e.renderOrder?i.renderOrder-e.renderOrder:i.z!==e.z?e.z-i.z:i.id-e.id}function Hd(){let i=[],e=0,t=[],n=[],s=[];function r(){e=0,t.length=0,n.length=0,s.length=0}function a(u){let f=0;return u.isInstancedMesh&&(f+=2),u.isSkinnedMesh&&(f+=1),f}function o(u,f,_,M,p,g){let S=i[e];return S===void 0?(S={id:u.id,object:u,geometry:f,material:_,materialVariant:a(u),groupOrder:M,renderOrder:u.renderOrder,z:p,group:g},i[e]=S):(S.id=u.id,S.object=u,S.geometry=f,S.material=_,S.materialVariant=a(u),S.groupOrder=M,S.renderOrder=u.renderOrder,S.z=p,S.group=g),e++,S}function l(u,f,_,M,p,g,S){S.reversedDepth===!0&&(p=-p);let P=o(u,f,_,M,p,g);_.transmission>0?n.push(P):_.transparent===!0?s.push(P):t.push(P)}function c(u,f,_,M,p,g){let S=o(u,f,_,M,p,g);_.transmission>0?n.unshift(S):_.transparent===!0?s.unshift(S):t.unshift(S)}function h(u,f){t.length>1&&t.sort(u||hv),n.length>1&&n.sort(f||Gd),s.length>1&&s.sort(f||Gd)}function d(){for(let u=e,f=i.length;u<f;u++){let _=i[u];if(_.id===null)break;_.id=null,_.object=null,_.geometry=null,_.material=null,_.group=null}}return{opaque:t,transmissive:n,transparent:s,init:r,push:l,unshift:c,finish:d,sort:h}}function uv(){let i=new WeakMap;function e(n,s){let r=i.get(n),a;return r===void 0?(a=new Hd,i.set(n,[a])):s>=r.length?(a=new Hd,r.push(a)):a=r[s],a}function t(){i=new WeakMap}return{get:e,dispose:t}}function dv(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new z,color:new Ge};break;case"SpotLight":t={position:new z,direction:new z,color:new Ge,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new z,color:new Ge,distance:0,decay:0};break;case"HemisphereLight":t={direction:new z,skyColor:new Ge,groundColor:new Ge};break;case"RectAreaLight":t={color:new Ge,position:new z,halfWidth:new z,halfHeight:new z};break}return i[e.id]=t,t}}}function fv(){let i={};return{get:function(e){if(i[e.id]!==void 0)return i[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Be};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Be};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Be,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[e.id]=t,t}}}var pv=0;function mv(i,e){return(e.castShadow?2:0)-(i.castShadow?2:0)+(e.map?1:0)-(i.map?1:0)}function gv(i){let e=new dv,t=fv(),n={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new z);let s=new z,r=new ut,a=new ut;function o(c){let h=0,d=0,u=0;for(let $=0;$<9;$++)n.probe[$].set(0,0,0);let f=0,_=0,M=0,p=0,g=0,S=0,P=0,w=0,I=0,R=0,y=0,T=0,X=0,F=0;c.sort(mv);for(let $=0,Q=c.length;$<Q;$++){let U=c[$],J=U.color,se=U.intensity,Z=U.distance,he=null;if(U.shadow&&U.shadow.map&&(U.shadow.map.texture.format===Mi?he=U.shadow.map.texture:he=U.shadow.map.depthTexture||U.shadow.map.texture),U.isAmbientLight)h+=J.r*se,d+=J.g*se,u+=J.b*se;else if(U.isLightProbe){for(let K=0;K<9;K++)n.probe[K].addScaledVector(U.sh.coefficients[K],se);F++}else if(U.isSunLight){let K=e.get(U);if(K.color.copy(U.color).multiplyScalar(U.intensity),U.castShadow){let oe=U.shadow,le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize.copy(oe.mapSize).multiply(oe.getFrameExtents()),n.sunShadow[_]=le,n.sunShadowMap[_]=he;let Re=oe.getViewportCount();for(let ke=0;ke<Re;ke++)n.sunShadowMatrix[M+ke]=oe.getMatrix(ke),n.sunShadowCascade[M+ke]=oe._cascadeData[ke];M+=Re,_++}n.sun[f]=K,f++}else if(U.isDirectionalLight){let K=e.get(U);if(K.color.copy(U.color).multiplyScalar(U.intensity),U.castShadow){let oe=U.shadow,le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize=oe.mapSize,n.directionalShadow[p]=le,n.directionalShadowMap[p]=he,n.directionalShadowMatrix[p]=U.shadow.matrix,I++}n.directional[p]=K,p++}else if(U.isSpotLight){let K=e.get(U);K.position.setFromMatrixPosition(U.matrixWorld),K.color.copy(J).multiplyScalar(se),K.distance=Z,K.coneCos=Math.cos(U.angle),K.penumbraCos=Math.cos(U.angle*(1-U.penumbra)),K.decay=U.decay,n.spot[S]=K;let oe=U.shadow;if(U.map&&(n.spotLightMap[T]=U.map,T++,oe.updateMatrices(U),U.castShadow&&X++),n.spotLightMatrix[S]=oe.matrix,U.castShadow){let le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize=oe.mapSize,n.spotShadow[S]=le,n.spotShadowMap[S]=he,y++}S++}else if(U.isRectAreaLight){let K=e.get(U);K.color.copy(J).multiplyScalar(se),K.halfWidth.set(U.width*.5,0,0),K.halfHeight.set(0,U.height*.5,0),n.rectArea[P]=K,P++}else if(U.isPointLight){let K=e.get(U);if(K.color.copy(U.color).multiplyScalar(U.intensity),K.distance=U.distance,K.decay=U.decay,U.castShadow){let oe=U.shadow,le=t.get(U);le.shadowIntensity=oe.intensity,le.shadowBias=oe.bias,le.shadowNormalBias=oe.normalBias,le.shadowRadius=oe.radius,le.shadowMapSize=oe.mapSize,le.shadowCameraNear=oe.camera.near,le.shadowCameraFar=oe.camera.far,n.pointShadow[g]=le,n.pointShadowMap[g]=he,n.pointShadowMatrix[g]=U.shadow.matrix,R++}n.point[g]=K,g++}else if(U.isHemisphereLight){let K=e.get(U);K.skyColor.copy(U.color).multiplyScalar(se),K.groundColor.copy(U.groundColor).multiplyScalar(se),n.hemi[w]=K,w++}}P>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=xe.LTC_FLOAT_1,n.rectAreaLTC2=xe.LTC_FLOAT_2):(n.rectAreaLTC1=xe.LTC_HALF_1,n.rectAreaLTC2=xe.LTC_HALF_2)),n.ambient[0]=h,n.ambient[1]=d,n.ambient[2]=u;let V=n.hash;(V.sunLength!==f||V.directionalLength!==p||V.pointLength!==g||V.spotLength!==S||V.rectAreaLength!==P||V.hemiLength!==w||V.numSunShadows!==_||V.numDirectionalShadows!==I||V.numPointShadows!==R||V.numSpotShadows!==y||V.numSpotMaps!==T||V.numLightProbes!==F)&&(n.sun.length=f,n.directional.length=p,n.spot.length=S,n.rectArea.length=P,n.point.length=g,n.hemi.length=w,n.sunShadow.length=_,n.sunShadowMap.length=_,n.sunShadowMatrix.length=M,n.sunShadowCascade.length=M,n.directionalShadow.length=I,n.directionalShadowMap.length=I,n.directionalShadowMatrix.length=I,n.pointShadow.length=R,n.pointShadowMap.length=R,n.pointShadowMatrix.length=R,n.spotShadow.length=y,n.spotShadowMap.length=y,n.spotLightMatrix.length=y+T-X,n.spotLightMap.length=T,n.numSpotLightShadowsWithMaps=X,n.numLightProbes=F,V.sunLength=f,V.directionalLength=p,V.pointLength=g,V.spotLength=S,V.rectAreaLength=P,V.hemiLength=w,V.numSunShadows=_,V.numDirectionalShadows=I,V.numPointShadows=R,V.numSpotShadows=y,V.numSpotMaps=T,V.numLightProbes=F,n.version=pv++)}function l(c,h){let d=0,u=0,f=0,_=0,M=0,p=0,g=h.matrixWorldInverse;for(let S=0,P=c.length;S<P;S++){let w=c[S];if(w.isSunLight){let I=n.sun[d];I.direction.setFromMatrixPosition(w.matrixWorld),I.direction.transformDirection(g),d++}else if(w.isDirectionalLight){let I=n.directional[u];I.direction.setFromMatrixPosition(w.matrixWorld),s.setFromMatrixPosition(w.target.matrixWorld),I.direction.sub(s),I.direction.transformDirection(g),u++}else if(w.isSpotLight){let I=n.spot[_];I.position.setFromMatrixPosition(w.matrixWorld),I.position.applyMatrix4(g),I.direction.setFromMatrixPosition(w.matrixWorld),s.setFromMatrixPosition(w.target.matrixWorld),I.direction.sub(s),I.direction.transformDirection(g),_++}else if(w.isRectAreaLight){let I=n.rectArea[M];I.position.setFromMatrixPosition(w.matrixWorld),I.position.applyMatrix4(g),a.identity(),r.copy(w.matrixWorld),r.premultiply(g),a.extractRotation(r),I.halfWidth.set(w.width*.5,0,0),I.halfHeight.set(0,w.height*.5,0),I.halfWidth.applyMatrix4(a),I.halfHeight.applyMatrix4(a),M++}else if(w.isPointLight){let I=n.point[f];I.position.setFromMatrixPosition(w.matrixWorld),I.position.applyMatrix4(g),f++}else if(w.isHemisphereLight){let I=n.hemi[p];I.direction.setFromMatrixPosition(w.matrixWorld),I.direction.transformDirection(g),p++}}}return{setup:o,setupView:l,state:n}}function Wd(i){let e=new gv(i),t=[],n=[],s=[];function r(d){h.camera=d,t.length=0,n.length=0,s.length=0}function a(d){d.isLightProbeGrid?s.push(d):t.push(d)}function o(d){n.push(d)}function l(){e.setup(t),s.sort((d,u)=>d.priority-u.priority||d.id-u.id)}function c(d){e.setupView(t,d)}let h={lightsArray:t,shadowsArray:n,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:l,setupLightsView:c,pushLight:a,pushShadow:o}}function _v(i){let e=new WeakMap;function t(s,r=0){let a=e.get(s),o;return a===void 0?(o=new Wd(i),e.set(s,[o])):r>=a.length?(o=new Wd(i),a.push(o)):o=a[r],o}function n(){e=new WeakMap}return{get:t,dispose:n}}var yv=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,vv=`uniform sampler2D shadow_pass;
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
}`,xv=[new z(1,0,0),new z(-1,0,0),new z(0,1,0),new z(0,-1,0),new z(0,0,1),new z(0,0,-1)],bv=[new z(0,-1,0),new z(0,-1,0),new z(0,0,1),new z(0,0,-1),new z(0,-1,0),new z(0,-1,0)],Xd=new ut,Er=new z,Dc=new z;function Mv(i,e,t){let n=new gi,s=new Be,r=new Be,a=new gt,o=new qa,l=new Ya,c={},h=t.maxTextureSize,d={[Nn]:Yt,[Yt]:Nn,[Qt]:Qt},u=new Ln({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Be},radius:{value:4}},vertexShader:yv,fragmentShader:vv}),f=u.clone();f.defines.HORIZONTAL_PASS=1;let _=new In;_.setAttribute("position",new bt(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let M=new qt(_,u),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=gr;let g=this.type;this.render=function(R,y,T){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||R.length===0)return;this.type===Bu&&(Ne("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=gr);let X=i.getRenderTarget(),F=i.getActiveCubeFace(),V=i.getActiveMipmapLevel(),$=i.state;$.setBlending(ki),$.buffers.depth.getReversed()===!0?$.buffers.color.setClear(0,0,0,0):$.buffers.color.setClear(1,1,1,1),$.buffers.depth.setTest(!0),$.setScissorTest(!1);let Q=g!==this.type;Q&&y.traverse(function(U){U.material&&(Array.isArray(U.material)?U.material.forEach(J=>J.needsUpdate=!0):U.material.needsUpdate=!0)});for(let U=0,J=R.length;U<J;U++){let se=R[U],Z=se.shadow;if(Z===void 0){Ne("WebGLShadowMap:",se,"has no shadow.");continue}if(Z.autoUpdate===!1&&Z.needsUpdate===!1)continue;s.copy(Z.mapSize);let he=Z.getFrameExtents();s.multiply(he),r.copy(Z.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/he.x),s.x=r.x*he.x,Z.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/he.y),s.y=r.y*he.y,Z.mapSize.y=r.y));let K=i.state.buffers.depth.getReversed();if(Z.camera._reversedDepth=K,Z.map===null||Q===!0){if(Z.map!==null&&(Z.map.depthTexture!==null&&(Z.map.depthTexture.dispose(),Z.map.depthTexture=null),Z.map.dispose()),this.type===Ts){if(se.isPointLight){Ne("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}Z.map=new ln(s.x,s.y,{format:Mi,type:hn,minFilter:wt,magFilter:wt,generateMipmaps:!1}),Z.map.texture.name=se.name+".shadowMap",Z.map.depthTexture=new Qn(s.x,s.y,Sn),Z.map.depthTexture.name=se.name+".shadowMapDepth",Z.map.depthTexture.format=Jn,Z.map.depthTexture.compareFunction=null,Z.map.depthTexture.minFilter=It,Z.map.depthTexture.magFilter=It}else se.isPointLight?(Z.map=new Tr(s.x),Z.map.depthTexture=new or(s.x,Mn)):(Z.map=new ln(s.x,s.y),Z.map.depthTexture=new Qn(s.x,s.y,Mn)),Z.map.depthTexture.name=se.name+".shadowMap",Z.map.depthTexture.format=Jn,this.type===gr?(Z.map.depthTexture.compareFunction=K?bc:xc,Z.map.depthTexture.minFilter=wt,Z.map.depthTexture.magFilter=wt):(Z.map.depthTexture.compareFunction=null,Z.map.depthTexture.minFilter=It,Z.map.depthTexture.magFilter=It);Z.camera.updateProjectionMatrix()}Z.map.isWebGLCubeRenderTarget!==!0&&(Z.map.width!==s.x||Z.map.height!==s.y)&&Z.map.setSize(s.x,s.y);let oe=Z.map.isWebGLCubeRenderTarget?6:Z.getViewportCount();se.isPointLight!==!0&&Z.updateMatrices(se,T);let le=(Z.camera.layers.mask&4294967294)!==0?Z.camera.layers:T.layers;for(let Re=0;Re<oe;Re++){let ke=Z.getCamera(Re);if(se.isPointLight){let ne=Z.camera,ve=Z.matrix,Me=se.distance||ne.far;Me!==ne.far&&(ne.far=Me,ne.updateProjectionMatrix()),Er.setFromMatrixPosition(se.matrixWorld),ne.position.copy(Er),Dc.copy(ne.position),Dc.add(xv[Re]),ne.up.copy(bv[Re]),ne.lookAt(Dc),ne.updateMatrixWorld(),ve.makeTranslation(-Er.x,-Er.y,-Er.z),Xd.multiplyMatrices(ne.projectionMatrix,ne.matrixWorldInverse),Z._frustum.setFromProjectionMatrix(Xd,ne.coordinateSystem,ne.reversedDepth)}if(Z.map.isWebGLCubeRenderTarget)i.setRenderTarget(Z.map,Re),i.clear();else{Re===0&&(i.setRenderTarget(Z.map),i.clear());let ne=Z.getViewport(Re);a.set(r.x*ne.x,r.y*ne.y,r.x*ne.z,r.y*ne.w),$.viewport(a)}n=Z.getFrustum(Re),w(y,T,ke,se,le,this.type)}Z.isPointLightShadow!==!0&&this.type===Ts&&S(Z,T),Z.needsUpdate=!1}g=this.type,p.needsUpdate=!1,i.setRenderTarget(X,F,V)};function S(R,y){let T=e.update(M);u.defines.VSM_SAMPLES!==R.blurSamples&&(u.defines.VSM_SAMPLES=R.blurSamples,f.defines.VSM_SAMPLES=R.blurSamples,u.needsUpdate=!0,f.needsUpdate=!0),R.mapPass===null?R.mapPass=new ln(s.x,s.y,{format:Mi,type:hn}):(R.mapPass.width!==R.map.width||R.mapPass.height!==R.map.height)&&R.mapPass.setSize(R.map.width,R.map.height),u.uniforms.shadow_pass.value=R.map.depthTexture,u.uniforms.resolution.value.set(R.map.width,R.map.height),u.uniforms.radius.value=R.radius,i.setRenderTarget(R.mapPass),i.clear(),i.renderBufferDirect(y,null,T,u,M,null),f.uniforms.shadow_pass.value=R.mapPass.texture,f.uniforms.resolution.value.set(R.map.width,R.map.height),f.uniforms.radius.value=R.radius,i.setRenderTarget(R.map),i.clear(),i.renderBufferDirect(y,null,T,f,M,null)}function P(R,y,T,X){let F=null,V=T.isPointLight===!0?R.customDistanceMaterial:R.customDepthMaterial;if(V!==void 0)F=V;else if(F=T.isPointLight===!0?l:o,i.localClippingEnabled&&y.clipShadows===!0&&Array.isArray(y.clippingPlanes)&&y.clippingPlanes.length!==0||y.displacementMap&&y.displacementScale!==0||y.alphaMap&&y.alphaTest>0||y.map&&y.alphaTest>0||y.alphaToCoverage===!0){let $=F.uuid,Q=y.uuid,U=c[$];U===void 0&&(U={},c[$]=U);let J=U[Q];J===void 0&&(J=F.clone(),U[Q]=J,y.addEventListener("dispose",I)),F=J}if(F.visible=y.visible,F.wireframe=y.wireframe,X===Ts?F.side=y.shadowSide!==null?y.shadowSide:y.side:F.side=y.shadowSide!==null?y.shadowSide:d[y.side],F.alphaMap=y.alphaMap,F.alphaTest=y.alphaToCoverage===!0?.5:y.alphaTest,F.map=y.map,F.clipShadows=y.clipShadows,F.clippingPlanes=y.clippingPlanes,F.clipIntersection=y.clipIntersection,F.displacementMap=y.displacementMap,F.displacementScale=y.displacementScale,F.displacementBias=y.displacementBias,F.wireframeLinewidth=y.wireframeLinewidth,F.linewidth=y.linewidth,T.isPointLight===!0&&F.isMeshDistanceMaterial===!0){let $=i.properties.get(F);$.light=T}return F}function w(R,y,T,X,F,V){if(R.visible===!1)return;if(R.layers.test(F)&&(R.isMesh||R.isLine||R.isPoints)&&(R.castShadow||R.receiveShadow&&V===Ts)&&(!R.frustumCulled||R.intersectsFrustum(n))){R.modelViewMatrix.multiplyMatrices(T.matrixWorldInverse,R.matrixWorld);let U=e.update(R),J=R.material;if(Array.isArray(J)){let se=U.groups;for(let Z=0,he=se.length;Z<he;Z++){let K=se[Z],oe=J[K.materialIndex];if(oe&&oe.visible){let le=P(R,oe,X,V);R.onBeforeShadow(i,R,y,T,U,le,K),i.renderBufferDirect(T,null,U,le,R,K),R.onAfterShadow(i,R,y,T,U,le,K)}}}else if(J.visible){let se=P(R,J,X,V);R.onBeforeShadow(i,R,y,T,U,se,null),i.renderBufferDirect(T,null,U,se,R,null),R.onAfterShadow(i,R,y,T,U,se,null)}}let Q=R.children;for(let U=0,J=Q.length;U<J;U++)w(Q[U],y,T,X,F,V)}function I(R){R.target.removeEventListener("dispose",I);for(let T in c){let X=c[T],F=R.target.uuid;F in X&&(X[F].dispose(),delete X[F])}}}function Sv(i,e){function t(){let L=!1,ie=new gt,m=null,b=new gt(0,0,0,0);return{setMask:function(E){m!==E&&!L&&(i.colorMask(E,E,E,E),m=E)},setLocked:function(E){L=E},setClear:function(E,C,D,k,B){B===!0&&(E*=k,C*=k,D*=k),ie.set(E,C,D,k),b.equals(ie)===!1&&(i.clearColor(E,C,D,k),b.copy(ie))},reset:function(){L=!1,m=null,b.set(-1,0,0,0)}}}function n(){let L=!1,ie=!1,m=null,b=null,E=null;return{setReversed:function(C){if(ie!==C){let D=e.get("EXT_clip_control");C?D.clipControlEXT(D.LOWER_LEFT_EXT,D.ZERO_TO_ONE_EXT):D.clipControlEXT(D.LOWER_LEFT_EXT,D.NEGATIVE_ONE_TO_ONE_EXT),ie=C;let k=E;E=null,this.setClear(k)}},getReversed:function(){return ie},setTest:function(C){C?_e(i.DEPTH_TEST):Ue(i.DEPTH_TEST)},setMask:function(C){m!==C&&!L&&(i.depthMask(C),m=C)},setFunc:function(C){if(ie&&(C=yd[C]),b!==C){switch(C){case La:i.depthFunc(i.NEVER);break;case Da:i.depthFunc(i.ALWAYS);break;case Na:i.depthFunc(i.LESS);break;case gs:i.depthFunc(i.LEQUAL);break;case Ua:i.depthFunc(i.EQUAL);break;case Fa:i.depthFunc(i.GEQUAL);break;case Oa:i.depthFunc(i.GREATER);break;case Ba:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}b=C}},setLocked:function(C){L=C},setClear:function(C){E!==C&&(E=C,ie&&(C=1-C),i.clearDepth(C))},reset:function(){L=!1,m=null,b=null,E=null,ie=!1}}}function s(){let L=!1,ie=null,m=null,b=null,E=null,C=null,D=null,k=null,B=null;return{setTest:function(q){L||(q?_e(i.STENCIL_TEST):Ue(i.STENCIL_TEST))},setMask:function(q){ie!==q&&!L&&(i.stencilMask(q),ie=q)},setFunc:function(q,ae,te){(m!==q||b!==ae||E!==te)&&(i.stencilFunc(q,ae,te),m=q,b=ae,E=te)},setOp:function(q,ae,te){(C!==q||D!==ae||k!==te)&&(i.stencilOp(q,ae,te),C=q,D=ae,k=te)},setLocked:function(q){L=q},setClear:function(q){B!==q&&(i.clearStencil(q),B=q)},reset:function(){L=!1,ie=null,m=null,b=null,E=null,C=null,D=null,k=null,B=null}}}let r=new t,a=new n,o=new s,l={},c=new WeakMap,h={},d={},u={},f=new WeakMap,_=[],M=null,p=!1,g=null,S=null,P=null,w=null,I=null,R=null,y=null,T=new Ge(0,0,0),X=0,F=!1,V=null,$=null,Q=null,U=null,J=null,se=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),Z=!1,he=0,K=i.getParameter(i.VERSION);K.indexOf("WebGL")!==-1?(he=parseFloat(/^WebGL (\d)/.exec(K)[1]),Z=he>=1):K.indexOf("OpenGL ES")!==-1&&(he=parseFloat(/^OpenGL ES (\d)/.exec(K)[1]),Z=he>=2);let oe=null,le={},Re=i.getParameter(i.SCISSOR_BOX),ke=i.getParameter(i.VIEWPORT),ne=new gt().fromArray(Re),ve=new gt().fromArray(ke);function Me(L,ie,m,b){let E=new Uint8Array(4),C=i.createTexture();i.bindTexture(L,C),i.texParameteri(L,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(L,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let D=0;D<m;D++)L===i.TEXTURE_3D||L===i.TEXTURE_2D_ARRAY?i.texImage3D(ie,0,i.RGBA,1,1,b,0,i.RGBA,i.UNSIGNED_BYTE,E):i.texImage2D(ie+D,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,E);return C}let Pe={};Pe[i.TEXTURE_2D]=Me(i.TEXTURE_2D,i.TEXTURE_2D,1),Pe[i.TEXTURE_CUBE_MAP]=Me(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Pe[i.TEXTURE_2D_ARRAY]=Me(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Pe[i.TEXTURE_3D]=Me(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),a.setClear(1),o.setClear(0),_e(i.DEPTH_TEST),a.setFunc(gs),Lt(!1),at(Ql),_e(i.CULL_FACE),Et(ki);function _e(L){h[L]!==!0&&(i.enable(L),h[L]=!0)}function Ue(L){h[L]!==!1&&(i.disable(L),h[L]=!1)}function dt(L,ie){return u[L]!==ie?(i.bindFramebuffer(L,ie),u[L]=ie,L===i.DRAW_FRAMEBUFFER&&(u[i.FRAMEBUFFER]=ie),L===i.FRAMEBUFFER&&(u[i.DRAW_FRAMEBUFFER]=ie),!0):!1}function De(L,ie){let m=_,b=!1;if(L){m=f.get(ie),m===void 0&&(m=[],f.set(ie,m));let E=L.textures;if(m.length!==E.length||m[0]!==i.COLOR_ATTACHMENT0){for(let C=0,D=E.length;C<D;C++)m[C]=i.COLOR_ATTACHMENT0+C;m.length=E.length,b=!0}}else m[0]!==i.BACK&&(m[0]=i.BACK,b=!0);b&&i.drawBuffers(m)}function je(L){return M!==L?(i.useProgram(L),M=L,!0):!1}let nt={[zi]:i.FUNC_ADD,[zu]:i.FUNC_SUBTRACT,[Vu]:i.FUNC_REVERSE_SUBTRACT};nt[Gu]=i.MIN,nt[Hu]=i.MAX;let Xe={[Wu]:i.ZERO,[Xu]:i.ONE,[qu]:i.SRC_COLOR,[ic]:i.SRC_ALPHA,[ju]:i.SRC_ALPHA_SATURATE,[Ku]:i.DST_COLOR,[$u]:i.DST_ALPHA,[Yu]:i.ONE_MINUS_SRC_COLOR,[sc]:i.ONE_MINUS_SRC_ALPHA,[Ju]:i.ONE_MINUS_DST_COLOR,[Zu]:i.ONE_MINUS_DST_ALPHA,[Qu]:i.CONSTANT_COLOR,[ed]:i.ONE_MINUS_CONSTANT_COLOR,[td]:i.CONSTANT_ALPHA,[nd]:i.ONE_MINUS_CONSTANT_ALPHA};function Et(L,ie,m,b,E,C,D,k,B,q){if(L===ki){p===!0&&(Ue(i.BLEND),p=!1);return}if(p===!1&&(_e(i.BLEND),p=!0),L!==ku){if(L!==g||q!==F){if((S!==zi||I!==zi)&&(i.blendEquation(i.FUNC_ADD),S=zi,I=zi),q)switch(L){case Rs:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case ec:i.blendFunc(i.ONE,i.ONE);break;case tc:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case nc:i.blendFuncSeparate(i.DST_COLOR,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE);break;default:Oe("WebGLState: Invalid blending: ",L);break}else switch(L){case Rs:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case ec:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE,i.ONE,i.ONE);break;case tc:Oe("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case nc:Oe("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Oe("WebGLState: Invalid blending: ",L);break}P=null,w=null,R=null,y=null,T.set(0,0,0),X=0,g=L,F=q}return}E=E||ie,C=C||m,D=D||b,(ie!==S||E!==I)&&(i.blendEquationSeparate(nt[ie],nt[E]),S=ie,I=E),(m!==P||b!==w||C!==R||D!==y)&&(i.blendFuncSeparate(Xe[m],Xe[b],Xe[C],Xe[D]),P=m,w=b,R=C,y=D),(k.equals(T)===!1||B!==X)&&(i.blendColor(k.r,k.g,k.b,B),T.copy(k),X=B),g=L,F=!1}function vt(L,ie){L.side===Qt?Ue(i.CULL_FACE):_e(i.CULL_FACE);let m=L.side===Yt;ie&&(m=!m),Lt(m),L.blending===Rs&&L.transparent===!1?Et(ki):Et(L.blending,L.blendEquation,L.blendSrc,L.blendDst,L.blendEquationAlpha,L.blendSrcAlpha,L.blendDstAlpha,L.blendColor,L.blendAlpha,L.premultipliedAlpha),a.setFunc(L.depthFunc),a.setTest(L.depthTest),a.setMask(L.depthWrite),r.setMask(L.colorWrite);let b=L.stencilWrite;o.setTest(b),b&&(o.setMask(L.stencilWriteMask),o.setFunc(L.stencilFunc,L.stencilRef,L.stencilFuncMask),o.setOp(L.stencilFail,L.stencilZFail,L.stencilZPass)),pt(L.polygonOffset,L.polygonOffsetFactor,L.polygonOffsetUnits),L.alphaToCoverage===!0?_e(i.SAMPLE_ALPHA_TO_COVERAGE):Ue(i.SAMPLE_ALPHA_TO_COVERAGE)}function Lt(L){V!==L&&(L?i.frontFace(i.CW):i.frontFace(i.CCW),V=L)}function at(L){L!==Fu?(_e(i.CULL_FACE),L!==$&&(L===Ql?i.cullFace(i.BACK):L===Ou?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):Ue(i.CULL_FACE),$=L}function un(L){L!==Q&&(Z&&i.lineWidth(L),Q=L)}function pt(L,ie,m){L?(_e(i.POLYGON_OFFSET_FILL),(U!==ie||J!==m)&&(U=ie,J=m,a.getReversed()&&(ie=-ie,m=-m),i.polygonOffset(ie,m))):Ue(i.POLYGON_OFFSET_FILL)}function $t(L){L?_e(i.SCISSOR_TEST):Ue(i.SCISSOR_TEST)}function Zt(L){L===void 0&&(L=i.TEXTURE0+se-1),oe!==L&&(i.activeTexture(L),oe=L)}function Kt(L,ie,m){m===void 0&&(oe===null?m=i.TEXTURE0+se-1:m=oe);let b=le[m];b===void 0&&(b={type:void 0,texture:void 0},le[m]=b),(b.type!==L||b.texture!==ie)&&(oe!==m&&(i.activeTexture(m),oe=m),i.bindTexture(L,ie||Pe[L]),b.type=L,b.texture=ie)}function O(){let L=le[oe];L!==void 0&&L.type!==void 0&&(i.bindTexture(L.type,null),L.type=void 0,L.texture=void 0)}function Jt(){try{i.compressedTexImage2D(...arguments)}catch(L){Oe("WebGLState:",L)}}function ot(){try{i.compressedTexImage3D(...arguments)}catch(L){Oe("WebGLState:",L)}}function lt(){try{i.texSubImage2D(...arguments)}catch(L){Oe("WebGLState:",L)}}function ye(){try{i.texSubImage3D(...arguments)}catch(L){Oe("WebGLState:",L)}}function _t(){try{i.compressedTexSubImage2D(...arguments)}catch(L){Oe("WebGLState:",L)}}function Le(){try{i.compressedTexSubImage3D(...arguments)}catch(L){Oe("WebGLState:",L)}}function Fe(){try{i.texStorage2D(...arguments)}catch(L){Oe("WebGLState:",L)}}function A(){try{i.texStorage3D(...arguments)}catch(L){Oe("WebGLState:",L)}}function v(){try{i.texImage2D(...arguments)}catch(L){Oe("WebGLState:",L)}}function G(){try{i.texImage3D(...arguments)}catch(L){Oe("WebGLState:",L)}}function ce(L){return d[L]!==void 0?d[L]:i.getParameter(L)}function re(L,ie){d[L]!==ie&&(i.pixelStorei(L,ie),d[L]=ie)}function de(L){ne.equals(L)===!1&&(i.scissor(L.x,L.y,L.z,L.w),ne.copy(L))}function pe(L){ve.equals(L)===!1&&(i.viewport(L.x,L.y,L.z,L.w),ve.copy(L))}function j(L,ie){let m=c.get(ie);m===void 0&&(m=new WeakMap,c.set(ie,m));let b=m.get(L);b===void 0&&(b=i.getUniformBlockIndex(ie,L.name),i.uniformBlockBinding(ie,b,b),m.set(L,b))}function ee(L,ie,m){let E=c.get(ie).get(L);l[E]!==m&&(i.bindBufferBase(i.UNIFORM_BUFFER,E,m),l[E]=m)}function fe(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),a.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),i.pixelStorei(i.PACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_ALIGNMENT,4),i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,!1),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,i.BROWSER_DEFAULT_WEBGL),i.pixelStorei(i.PACK_ROW_LENGTH,0),i.pixelStorei(i.PACK_SKIP_PIXELS,0),i.pixelStorei(i.PACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_ROW_LENGTH,0),i.pixelStorei(i.UNPACK_IMAGE_HEIGHT,0),i.pixelStorei(i.UNPACK_SKIP_PIXELS,0),i.pixelStorei(i.UNPACK_SKIP_ROWS,0),i.pixelStorei(i.UNPACK_SKIP_IMAGES,0),h={},d={},oe=null,le={},u={},l={},f=new WeakMap,_=[],M=null,p=!1,g=null,S=null,P=null,w=null,I=null,R=null,y=null,T=new Ge(0,0,0),X=0,F=!1,V=null,$=null,Q=null,U=null,J=null,ne.set(0,0,i.canvas.width,i.canvas.height),ve.set(0,0,i.canvas.width,i.canvas.height),r.reset(),a.reset(),o.reset()}return{buffers:{color:r,depth:a,stencil:o},enable:_e,disable:Ue,bindFramebuffer:dt,drawBuffers:De,useProgram:je,setBlending:Et,setMaterial:vt,setFlipSided:Lt,setCullFace:at,setLineWidth:un,setPolygonOffset:pt,setScissorTest:$t,activeTexture:Zt,bindTexture:Kt,unbindTexture:O,compressedTexImage2D:Jt,compressedTexImage3D:ot,texImage2D:v,texImage3D:G,pixelStorei:re,getParameter:ce,updateUBOMapping:j,uniformBlockBinding:ee,texStorage2D:Fe,texStorage3D:A,texSubImage2D:lt,texSubImage3D:ye,compressedTexSubImage2D:_t,compressedTexSubImage3D:Le,scissor:de,viewport:pe,reset:fe}}function wv(i,e,t,n,s,r,a){let o=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new Be,h=new WeakMap,d=new Set,u,f=new WeakMap,_=new Set,M=new FinalizationRegistry(A=>_.delete(A)),p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function g(A,v){return p?new OffscreenCanvas(A,v):Qs("canvas")}function S(A,v,G){let ce=1,re=Fe(A);if((re.width>G||re.height>G)&&(ce=G/Math.max(re.width,re.height)),ce<1)if(typeof HTMLImageElement<"u"&&A instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&A instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&A instanceof ImageBitmap||typeof VideoFrame<"u"&&A instanceof VideoFrame){let de=Math.floor(ce*re.width),pe=Math.floor(ce*re.height);u===void 0&&(u=g(de,pe));let j=v?g(de,pe):u;return j.width=de,j.height=pe,j.getContext("2d").drawImage(A,0,0,de,pe),Ne("WebGLRenderer: Texture has been resized from ("+re.width+"x"+re.height+") to ("+de+"x"+pe+")."),j}else return"data"in A&&Ne("WebGLRenderer: Image in DataTexture is too big ("+re.width+"x"+re.height+")."),A;return A}function P(A){return A.generateMipmaps}function w(A){i.generateMipmap(A)}function I(A){return A.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:A.isWebGL3DRenderTarget?i.TEXTURE_3D:A.isWebGLArrayRenderTarget||A.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function R(A,v,G,ce,re,de=!1){if(A!==null){if(i[A]!==void 0)return i[A];Ne("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+A+"'")}let pe;ce&&(pe=e.get("EXT_texture_norm16"),pe||Ne("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let j=v;if(v===i.RED&&(G===i.FLOAT&&(j=i.R32F),G===i.HALF_FLOAT&&(j=i.R16F),G===i.UNSIGNED_BYTE&&(j=i.R8),G===i.UNSIGNED_SHORT&&pe&&(j=pe.R16_EXT),G===i.SHORT&&pe&&(j=pe.R16_SNORM_EXT)),v===i.RED_INTEGER&&(G===i.UNSIGNED_BYTE&&(j=i.R8UI),G===i.UNSIGNED_SHORT&&(j=i.R16UI),G===i.UNSIGNED_INT&&(j=i.R32UI),G===i.BYTE&&(j=i.R8I),G===i.SHORT&&(j=i.R16I),G===i.INT&&(j=i.R32I)),v===i.RG&&(G===i.FLOAT&&(j=i.RG32F),G===i.HALF_FLOAT&&(j=i.RG16F),G===i.UNSIGNED_BYTE&&(j=i.RG8),G===i.UNSIGNED_SHORT&&pe&&(j=pe.RG16_EXT),G===i.SHORT&&pe&&(j=pe.RG16_SNORM_EXT)),v===i.RG_INTEGER&&(G===i.UNSIGNED_BYTE&&(j=i.RG8UI),G===i.UNSIGNED_SHORT&&(j=i.RG16UI),G===i.UNSIGNED_INT&&(j=i.RG32UI),G===i.BYTE&&(j=i.RG8I),G===i.SHORT&&(j=i.RG16I),G===i.INT&&(j=i.RG32I)),v===i.RGB_INTEGER&&(G===i.UNSIGNED_BYTE&&(j=i.RGB8UI),G===i.UNSIGNED_SHORT&&(j=i.RGB16UI),G===i.UNSIGNED_INT&&(j=i.RGB32UI),G===i.BYTE&&(j=i.RGB8I),G===i.SHORT&&(j=i.RGB16I),G===i.INT&&(j=i.RGB32I)),v===i.RGBA_INTEGER&&(G===i.UNSIGNED_BYTE&&(j=i.RGBA8UI),G===i.UNSIGNED_SHORT&&(j=i.RGBA16UI),G===i.UNSIGNED_INT&&(j=i.RGBA32UI),G===i.BYTE&&(j=i.RGBA8I),G===i.SHORT&&(j=i.RGBA16I),G===i.INT&&(j=i.RGBA32I)),v===i.RGB&&(G===i.UNSIGNED_SHORT&&pe&&(j=pe.RGB16_EXT),G===i.SHORT&&pe&&(j=pe.RGB16_SNORM_EXT),G===i.UNSIGNED_INT_5_9_9_9_REV&&(j=i.RGB9_E5),G===i.UNSIGNED_INT_10F_11F_11F_REV&&(j=i.R11F_G11F_B10F)),v===i.RGBA){let ee=de?js:Ke.getTransfer(re);G===i.FLOAT&&(j=i.RGBA32F),G===i.HALF_FLOAT&&(j=i.RGBA16F),G===i.UNSIGNED_BYTE&&(j=ee===st?i.SRGB8_ALPHA8:i.RGBA8),G===i.UNSIGNED_SHORT&&pe&&(j=pe.RGBA16_EXT),G===i.SHORT&&pe&&(j=pe.RGBA16_SNORM_EXT),G===i.UNSIGNED_SHORT_4_4_4_4&&(j=i.RGBA4),G===i.UNSIGNED_SHORT_5_5_5_1&&(j=i.RGB5_A1)}return(j===i.R16F||j===i.R32F||j===i.RG16F||j===i.RG32F||j===i.RGBA16F||j===i.RGBA32F)&&e.get("EXT_color_buffer_float"),j}function y(A,v){let G;return A?v===null||v===Mn||v===Gi?G=i.DEPTH24_STENCIL8:v===Sn?G=i.DEPTH32F_STENCIL8:v===Is&&(G=i.DEPTH24_STENCIL8,Ne("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):v===null||v===Mn||v===Gi?G=i.DEPTH_COMPONENT24:v===Sn?G=i.DEPTH_COMPONENT32F:v===Is&&(G=i.DEPTH_COMPONENT16),G}function T(A,v){return P(A)===!0||A.isFramebufferTexture&&A.minFilter!==It&&A.minFilter!==wt?Math.log2(Math.max(v.width,v.height))+1:A.mipmaps.length>0?A.mipmaps.length:A.isCompressedTexture&&Array.isArray(A.image)?v.mipmaps.length:1}function X(A){let v=new WeakRef(A);n.get(A).__ref=v,_.add(v),M.register(A,v,v)}function F(A){let v=n.get(A).__ref;v!==void 0&&(_.delete(v),M.unregister(v))}function V(A){Q(A.target)}function $(A){U(A.target)}function Q(A){A.removeEventListener("dispose",V),F(A),se(A),A.isVideoTexture&&h.delete(A),A.isHTMLTexture&&d.delete(A)}function U(A){A.removeEventListener("dispose",$),F(A),he(A)}function J(){for(let A of _){let v=A.deref();v!==void 0&&(v.isRenderTarget===!0?U(v):Q(v))}_.clear(),d.clear()}function se(A){let v=n.get(A);if(v.__webglInit===void 0)return;let G=A.source,ce=f.get(G);if(ce){let re=ce[v.__cacheKey];re.usedTimes--,re.usedTimes===0&&Z(A),Object.keys(ce).length===0&&f.delete(G)}n.remove(A)}function Z(A){let v=n.get(A);i.deleteTexture(v.__webglTexture);let G=A.source,ce=f.get(G);delete ce[v.__cacheKey],a.memory.textures--}function he(A){let v=n.get(A);v.__depthDisposeCallback&&v.__depthDisposeCallback();let G=A.depthTexture;if(G&&G.renderTarget===A&&Q(G),A.isWebGLCubeRenderTarget)for(let re=0;re<6;re++){if(Array.isArray(v.__webglFramebuffer[re]))for(let de=0;de<v.__webglFramebuffer[re].length;de++)i.deleteFramebuffer(v.__webglFramebuffer[re][de]);else i.deleteFramebuffer(v.__webglFramebuffer[re]);v.__webglDepthbuffer&&i.deleteRenderbuffer(v.__webglDepthbuffer[re])}else{if(Array.isArray(v.__webglFramebuffer))for(let re=0;re<v.__webglFramebuffer.length;re++)i.deleteFramebuffer(v.__webglFramebuffer[re]);else i.deleteFramebuffer(v.__webglFramebuffer);if(v.__webglDepthbuffer&&i.deleteRenderbuffer(v.__webglDepthbuffer),v.__webglMultisampledFramebuffer&&i.deleteFramebuffer(v.__webglMultisampledFramebuffer),v.__webglColorRenderbuffer)for(let re=0;re<v.__webglColorRenderbuffer.length;re++)v.__webglColorRenderbuffer[re]&&i.deleteRenderbuffer(v.__webglColorRenderbuffer[re]);v.__webglDepthRenderbuffer&&i.deleteRenderbuffer(v.__webglDepthRenderbuffer)}let ce=A.textures;for(let re=0,de=ce.length;re<de;re++){let pe=n.get(ce[re]);pe.__webglTexture&&(i.deleteTexture(pe.__webglTexture),a.memory.textures--),n.remove(ce[re])}n.remove(A)}let K=0;function oe(){K=0}function le(){return K}function Re(A){K=A}function ke(){let A=K;return A>=s.maxTextures&&Ne("WebGLTextures: Trying to use "+(A+1)+" texture units while this GPU supports only "+s.maxTextures),K+=1,A}function ne(A){let v=[];return v.push(A.wrapS),v.push(A.wrapT),v.push(A.wrapR||0),v.push(A.magFilter),v.push(A.minFilter),v.push(A.anisotropy),v.push(A.internalFormat),v.push(A.format),v.push(A.type),v.push(A.generateMipmaps),v.push(A.mipmapsAutoUpdate),v.push(A.premultiplyAlpha),v.push(A.flipY),v.push(A.unpackAlignment),v.push(A.colorSpace),v.join()}function ve(A,v){let G=n.get(A);if(A.isVideoTexture&&_t(A),A.isRenderTargetTexture===!1&&A.isExternalTexture!==!0&&A.version>0&&G.__version!==A.version){let ce=A.image;if(ce===null)Ne("WebGLRenderer: Texture marked for update but no image data found.");else if(ce.complete===!1)Ne("WebGLRenderer: Texture marked for update but image is incomplete");else{vt(G,A,v);return}}else A.isExternalTexture&&(G.__webglTexture=A.sourceTexture?A.sourceTexture:null);t.bindTexture(i.TEXTURE_2D,G.__webglTexture,i.TEXTURE0+v)}function Me(A,v){let G=n.get(A);if(A.isRenderTargetTexture===!1&&A.version>0&&G.__version!==A.version){vt(G,A,v);return}else A.isExternalTexture&&(G.__webglTexture=A.sourceTexture?A.sourceTexture:null);t.bindTexture(i.TEXTURE_2D_ARRAY,G.__webglTexture,i.TEXTURE0+v)}function Pe(A,v){let G=n.get(A);if(A.isRenderTargetTexture===!1&&A.version>0&&G.__version!==A.version){vt(G,A,v);return}t.bindTexture(i.TEXTURE_3D,G.__webglTexture,i.TEXTURE0+v)}function _e(A,v){let G=n.get(A);if(A.version>0&&G.__version!==A.version){Lt(G,A,v);return}t.bindTexture(i.TEXTURE_CUBE_MAP,G.__webglTexture,i.TEXTURE0+v)}let Ue={[_s]:i.REPEAT,[Cn]:i.CLAMP_TO_EDGE,[ka]:i.MIRRORED_REPEAT},dt={[It]:i.NEAREST,[rd]:i.NEAREST_MIPMAP_NEAREST,[yr]:i.NEAREST_MIPMAP_LINEAR,[wt]:i.LINEAR,[oo]:i.LINEAR_MIPMAP_NEAREST,[ei]:i.LINEAR_MIPMAP_LINEAR},De={[cd]:i.NEVER,[Mc]:i.ALWAYS,[hd]:i.LESS,[xc]:i.LEQUAL,[ud]:i.EQUAL,[bc]:i.GEQUAL,[dd]:i.GREATER,[fd]:i.NOTEQUAL};function je(A,v){if(v.type===Sn&&e.has("OES_texture_float_linear")===!1&&(v.magFilter===wt||v.magFilter===oo||v.magFilter===yr||v.magFilter===ei||v.minFilter===wt||v.minFilter===oo||v.minFilter===yr||v.minFilter===ei)&&Ne("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(A,i.TEXTURE_WRAP_S,Ue[v.wrapS]),i.texParameteri(A,i.TEXTURE_WRAP_T,Ue[v.wrapT]),(A===i.TEXTURE_3D||A===i.TEXTURE_2D_ARRAY)&&i.texParameteri(A,i.TEXTURE_WRAP_R,Ue[v.wrapR]),i.texParameteri(A,i.TEXTURE_MAG_FILTER,dt[v.magFilter]),i.texParameteri(A,i.TEXTURE_MIN_FILTER,dt[v.minFilter]),v.compareFunction&&(i.texParameteri(A,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(A,i.TEXTURE_COMPARE_FUNC,De[v.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(v.magFilter===It||v.minFilter!==yr&&v.minFilter!==ei||v.type===Sn&&e.has("OES_texture_float_linear")===!1)return;if(v.anisotropy>1||n.get(v).__currentAnisotropy){let G=e.get("EXT_texture_filter_anisotropic");i.texParameterf(A,G.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(v.anisotropy,s.getMaxAnisotropy())),n.get(v).__currentAnisotropy=v.anisotropy}}}function nt(A,v){let G=!1;A.__webglInit===void 0&&(A.__webglInit=!0,v.addEventListener("dispose",V),X(v));let ce=v.source,re=f.get(ce);re===void 0&&(re={},f.set(ce,re));let de=ne(v);if(de!==A.__cacheKey){re[de]===void 0&&(re[de]={texture:i.createTexture(),usedTimes:0},a.memory.textures++,G=!0),re[de].usedTimes++;let pe=re[A.__cacheKey];pe!==void 0&&(re[A.__cacheKey].usedTimes--,pe.usedTimes===0&&Z(v)),A.__cacheKey=de,A.__webglTexture=re[de].texture}return G}function Xe(A,v,G){return Math.floor(Math.floor(A/G)/v)}function Et(A,v,G,ce){let de=A.updateRanges;if(de.length===0)t.texSubImage2D(i.TEXTURE_2D,0,0,0,v.width,v.height,G,ce,v.data);else{de.sort((L,ie)=>L.start-ie.start);let pe=0;for(let L=1;L<de.length;L++){let ie=de[pe],m=de[L],b=ie.start+ie.count,E=Xe(m.start,v.width,4),C=Xe(ie.start,v.width,4);m.start<=b+1&&E===C&&Xe(m.start+m.count-1,v.width,4)===E?ie.count=Math.max(ie.count,m.start+m.count-ie.start):(++pe,de[pe]=m)}de.length=pe+1;let j=t.getParameter(i.UNPACK_ROW_LENGTH),ee=t.getParameter(i.UNPACK_SKIP_PIXELS),fe=t.getParameter(i.UNPACK_SKIP_ROWS);t.pixelStorei(i.UNPACK_ROW_LENGTH,v.width);for(let L=0,ie=de.length;L<ie;L++){let m=de[L],b=Math.floor(m.start/4),E=Math.ceil(m.count/4),C=b%v.width,D=Math.floor(b/v.width),k=E,B=1;t.pixelStorei(i.UNPACK_SKIP_PIXELS,C),t.pixelStorei(i.UNPACK_SKIP_ROWS,D),t.texSubImage2D(i.TEXTURE_2D,0,C,D,k,B,G,ce,v.data)}A.clearUpdateRanges(),t.pixelStorei(i.UNPACK_ROW_LENGTH,j),t.pixelStorei(i.UNPACK_SKIP_PIXELS,ee),t.pixelStorei(i.UNPACK_SKIP_ROWS,fe)}}function vt(A,v,G){let ce=i.TEXTURE_2D;(v.isDataArrayTexture||v.isCompressedArrayTexture)&&(ce=i.TEXTURE_2D_ARRAY),v.isData3DTexture&&(ce=i.TEXTURE_3D);let re=nt(A,v),de=v.source;t.bindTexture(ce,A.__webglTexture,i.TEXTURE0+G);let pe=n.get(de);if(de.version!==pe.__version||re===!0){if(t.activeTexture(i.TEXTURE0+G),(typeof ImageBitmap<"u"&&v.image instanceof ImageBitmap)===!1){let B=Ke.getPrimaries(Ke.workingColorSpace),q=v.colorSpace===En?null:Ke.getPrimaries(v.colorSpace),ae=v.colorSpace===En||B===q?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,v.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,v.premultiplyAlpha),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,ae)}t.pixelStorei(i.UNPACK_ALIGNMENT,v.unpackAlignment);let ee=S(v.image,!1,s.maxTextureSize);ee=Le(v,ee);let fe=r.convert(v.format,v.colorSpace),L=r.convert(v.type),ie=R(v.internalFormat,fe,L,v.normalized,v.colorSpace,v.isVideoTexture);je(ce,v);let m,b=v.mipmaps,E=v.isVideoTexture!==!0,C=pe.__version===void 0||re===!0,D=de.dataReady,k=T(v,ee);if(v.isDepthTexture)ie=y(v.format===ti,v.type),C&&(E?t.texStorage2D(i.TEXTURE_2D,1,ie,ee.width,ee.height):t.texImage2D(i.TEXTURE_2D,0,ie,ee.width,ee.height,0,fe,L,null));else if(v.isDataTexture)if(b.length>0){E&&C&&t.texStorage2D(i.TEXTURE_2D,k,ie,b[0].width,b[0].height);for(let B=0,q=b.length;B<q;B++)m=b[B],E?D&&t.texSubImage2D(i.TEXTURE_2D,B,0,0,m.width,m.height,fe,L,m.data):t.texImage2D(i.TEXTURE_2D,B,ie,m.width,m.height,0,fe,L,m.data);v.generateMipmaps=!1}else E?(C&&t.texStorage2D(i.TEXTURE_2D,k,ie,ee.width,ee.height),D&&Et(v,ee,fe,L)):t.texImage2D(i.TEXTURE_2D,0,ie,ee.width,ee.height,0,fe,L,ee.data);else if(v.isCompressedTexture)if(v.isCompressedArrayTexture){E&&C&&t.texStorage3D(i.TEXTURE_2D_ARRAY,k,ie,b[0].width,b[0].height,ee.depth);for(let B=0,q=b.length;B<q;B++)if(m=b[B],v.format!==wn)if(fe!==null)if(E){if(D)if(v.layerUpdates.size>0){let ae=Ic(m.width,m.height,v.format,v.type);for(let te of v.layerUpdates){let ue=m.data.subarray(te*ae/m.data.BYTES_PER_ELEMENT,(te+1)*ae/m.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,B,0,0,te,m.width,m.height,1,fe,ue)}}else t.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,B,0,0,0,m.width,m.height,ee.depth,fe,m.data)}else t.compressedTexImage3D(i.TEXTURE_2D_ARRAY,B,ie,m.width,m.height,ee.depth,0,m.data,0,0);else Ne("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else E?D&&t.texSubImage3D(i.TEXTURE_2D_ARRAY,B,0,0,0,m.width,m.height,ee.depth,fe,L,m.data):t.texImage3D(i.TEXTURE_2D_ARRAY,B,ie,m.width,m.height,ee.depth,0,fe,L,m.data);v.layerUpdates.size>0&&v.clearLayerUpdates()}else{E&&C&&t.texStorage2D(i.TEXTURE_2D,k,ie,b[0].width,b[0].height);for(let B=0,q=b.length;B<q;B++)m=b[B],v.format!==wn?fe!==null?E?D&&t.compressedTexSubImage2D(i.TEXTURE_2D,B,0,0,m.width,m.height,fe,m.data):t.compressedTexImage2D(i.TEXTURE_2D,B,ie,m.width,m.height,0,m.data):Ne("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):E?D&&t.texSubImage2D(i.TEXTURE_2D,B,0,0,m.width,m.height,fe,L,m.data):t.texImage2D(i.TEXTURE_2D,B,ie,m.width,m.height,0,fe,L,m.data)}else if(v.isDataArrayTexture)if(E){if(C&&t.texStorage3D(i.TEXTURE_2D_ARRAY,k,ie,ee.width,ee.height,ee.depth),D)if(v.layerUpdates.size>0){let B=Ic(ee.width,ee.height,v.format,v.type);for(let q of v.layerUpdates){let ae=ee.data.subarray(q*B/ee.data.BYTES_PER_ELEMENT,(q+1)*B/ee.data.BYTES_PER_ELEMENT);t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,q,ee.width,ee.height,1,fe,L,ae)}v.clearLayerUpdates()}else t.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,ee.width,ee.height,ee.depth,fe,L,ee.data)}else t.texImage3D(i.TEXTURE_2D_ARRAY,0,ie,ee.width,ee.height,ee.depth,0,fe,L,ee.data);else if(v.isData3DTexture)E?(C&&t.texStorage3D(i.TEXTURE_3D,k,ie,ee.width,ee.height,ee.depth),D&&t.texSubImage3D(i.TEXTURE_3D,0,0,0,0,ee.width,ee.height,ee.depth,fe,L,ee.data)):t.texImage3D(i.TEXTURE_3D,0,ie,ee.width,ee.height,ee.depth,0,fe,L,ee.data);else if(v.isFramebufferTexture){if(C)if(E)t.texStorage2D(i.TEXTURE_2D,k,ie,ee.width,ee.height);else{let B=ee.width,q=ee.height;for(let ae=0;ae<k;ae++)t.texImage2D(i.TEXTURE_2D,ae,ie,B,q,0,fe,L,null),B>>=1,q>>=1}}else if(v.isHTMLTexture){if("texElementImage2D"in i){let B=i.canvas;if(B.hasAttribute("layoutsubtree")||B.setAttribute("layoutsubtree","true"),ee.parentNode!==B){B.appendChild(ee),d.add(v),B.onpaint=q=>{let ae=q.changedElements;for(let te of d)ae.includes(te.image)&&(te.needsUpdate=!0)},B.requestPaint();return}if(i.texElementImage2D.length===3)i.texElementImage2D(i.TEXTURE_2D,i.RGBA8,ee);else{let ae=i.RGBA,te=i.RGBA,ue=i.UNSIGNED_BYTE;i.texElementImage2D(i.TEXTURE_2D,0,ae,te,ue,ee)}i.texParameteri(i.TEXTURE_2D,i.TEXTURE_MIN_FILTER,i.LINEAR),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_S,i.CLAMP_TO_EDGE),i.texParameteri(i.TEXTURE_2D,i.TEXTURE_WRAP_T,i.CLAMP_TO_EDGE)}}else if(b.length>0){if(E&&C){let B=Fe(b[0]);t.texStorage2D(i.TEXTURE_2D,k,ie,B.width,B.height)}for(let B=0,q=b.length;B<q;B++)m=b[B],E?D&&t.texSubImage2D(i.TEXTURE_2D,B,0,0,fe,L,m):t.texImage2D(i.TEXTURE_2D,B,ie,fe,L,m);v.generateMipmaps=!1}else if(E){if(C){let B=Fe(ee);t.texStorage2D(i.TEXTURE_2D,k,ie,B.width,B.height)}D&&t.texSubImage2D(i.TEXTURE_2D,0,0,0,fe,L,ee)}else t.texImage2D(i.TEXTURE_2D,0,ie,fe,L,ee);P(v)&&v.mipmapsAutoUpdate===!0&&w(ce),pe.__version=de.version,v.onUpdate&&v.onUpdate(v)}A.__version=v.version}function Lt(A,v,G){if(v.image.length!==6)return;let ce=nt(A,v),re=v.source;t.bindTexture(i.TEXTURE_CUBE_MAP,A.__webglTexture,i.TEXTURE0+G);let de=n.get(re);if(re.version!==de.__version||ce===!0){t.activeTexture(i.TEXTURE0+G);let pe=Ke.getPrimaries(Ke.workingColorSpace),j=v.colorSpace===En?null:Ke.getPrimaries(v.colorSpace),ee=v.colorSpace===En||pe===j?i.NONE:i.BROWSER_DEFAULT_WEBGL;t.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,v.flipY),t.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,v.premultiplyAlpha),t.pixelStorei(i.UNPACK_ALIGNMENT,v.unpackAlignment),t.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,ee);let fe=v.isCompressedTexture||v.image[0].isCompressedTexture,L=v.image[0]&&v.image[0].isDataTexture,ie=[];for(let te=0;te<6;te++)!fe&&!L?ie[te]=S(v.image[te],!0,s.maxCubemapSize):ie[te]=L?v.image[te].image:v.image[te],ie[te]=Le(v,ie[te]);let m=ie[0],b=r.convert(v.format,v.colorSpace),E=r.convert(v.type),C=R(v.internalFormat,b,E,v.normalized,v.colorSpace),D=v.isVideoTexture!==!0,k=de.__version===void 0||ce===!0,B=re.dataReady,q=T(v,m);je(i.TEXTURE_CUBE_MAP,v);let ae;if(v.isDepthTexture){if(C=y(v.format===ti,v.type),k)if(D)t.texStorage2D(i.TEXTURE_CUBE_MAP,1,C,m.width,m.height);else for(let te=0;te<6;te++)t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,0,C,m.width,m.height,0,b,E,null)}else if(fe){D&&k&&t.texStorage2D(i.TEXTURE_CUBE_MAP,q,C,m.width,m.height);for(let te=0;te<6;te++){ae=ie[te].mipmaps;for(let ue=0;ue<ae.length;ue++){let Se=ae[ue];v.format!==wn?b!==null?D?B&&t.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue,0,0,Se.width,Se.height,b,Se.data):t.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue,C,Se.width,Se.height,0,Se.data):Ne("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):D?B&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue,0,0,Se.width,Se.height,b,E,Se.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue,C,Se.width,Se.height,0,b,E,Se.data)}}}else{if(ae=v.mipmaps,D&&k){ae.length>0&&q++;let te=Fe(ie[0]);t.texStorage2D(i.TEXTURE_CUBE_MAP,q,C,te.width,te.height)}for(let te=0;te<6;te++)if(L){D?B&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,0,0,0,ie[te].width,ie[te].height,b,E,ie[te].data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,0,C,ie[te].width,ie[te].height,0,b,E,ie[te].data);for(let ue=0;ue<ae.length;ue++){let qe=ae[ue].image[te].image;D?B&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue+1,0,0,qe.width,qe.height,b,E,qe.data):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue+1,C,qe.width,qe.height,0,b,E,qe.data)}}else{D?B&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,0,0,0,b,E,ie[te]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,0,C,b,E,ie[te]);for(let ue=0;ue<ae.length;ue++){let Se=ae[ue];D?B&&t.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue+1,0,0,b,E,Se.image[te]):t.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+te,ue+1,C,b,E,Se.image[te])}}}P(v)&&v.mipmapsAutoUpdate===!0&&w(i.TEXTURE_CUBE_MAP),de.__version=re.version,v.onUpdate&&v.onUpdate(v)}A.__version=v.version}function at(A,v,G,ce,re,de){let pe=r.convert(G.format,G.colorSpace),j=r.convert(G.type),ee=R(G.internalFormat,pe,j,G.normalized,G.colorSpace),fe=n.get(v),L=n.get(G);if(L.__renderTarget=v,!fe.__hasExternalTextures){let ie=Math.max(1,v.width>>de),m=Math.max(1,v.height>>de);re===i.TEXTURE_3D||re===i.TEXTURE_2D_ARRAY?t.texImage3D(re,de,ee,ie,m,v.depth,0,pe,j,null):t.texImage2D(re,de,ee,ie,m,0,pe,j,null)}t.bindFramebuffer(i.FRAMEBUFFER,A),ye(v)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,ce,re,L.__webglTexture,0,lt(v)):(re===i.TEXTURE_2D||re>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&re<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,ce,re,L.__webglTexture,de),t.bindFramebuffer(i.FRAMEBUFFER,null)}function un(A,v,G){if(i.bindRenderbuffer(i.RENDERBUFFER,A),v.depthBuffer){let ce=v.depthTexture,re=ce&&ce.isDepthTexture?ce.type:null,de=y(v.stencilBuffer,re),pe=v.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;ye(v)?o.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,lt(v),de,v.width,v.height):G?i.renderbufferStorageMultisample(i.RENDERBUFFER,lt(v),de,v.width,v.height):i.renderbufferStorage(i.RENDERBUFFER,de,v.width,v.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,pe,i.RENDERBUFFER,A)}else{let ce=v.textures;for(let re=0;re<ce.length;re++){let de=ce[re],pe=r.convert(de.format,de.colorSpace),j=r.convert(de.type),ee=R(de.internalFormat,pe,j,de.normalized,de.colorSpace);ye(v)?o.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,lt(v),ee,v.width,v.height):G?i.renderbufferStorageMultisample(i.RENDERBUFFER,lt(v),ee,v.width,v.height):i.renderbufferStorage(i.RENDERBUFFER,ee,v.width,v.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function pt(A,v,G){let ce=v.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(i.FRAMEBUFFER,A),!(v.depthTexture&&v.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let re=n.get(v.depthTexture);re.__renderTarget=v;let de=ce?v.depthTexture.image[0]:v.depthTexture.image;(!re.__webglTexture||de.width!==v.width||de.height!==v.height)&&(de.width=v.width,de.height=v.height,v.depthTexture.needsUpdate=!0),ce?_e(v.depthTexture,0):ve(v.depthTexture,0);let pe=re.__webglTexture,j=lt(v),ee=ce?i.TEXTURE_CUBE_MAP_POSITIVE_X+G:i.TEXTURE_2D,fe=v.depthTexture.format===ti?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;if(v.depthTexture.format===Jn)ye(v)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,fe,ee,pe,0,j):i.framebufferTexture2D(i.FRAMEBUFFER,fe,ee,pe,0);else if(v.depthTexture.format===ti)ye(v)?o.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,fe,ee,pe,0,j):i.framebufferTexture2D(i.FRAMEBUFFER,fe,ee,pe,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function $t(A){let v=n.get(A),G=A.isWebGLCubeRenderTarget===!0;if(v.__boundDepthTexture!==A.depthTexture){let ce=A.depthTexture;if(v.__depthDisposeCallback&&v.__depthDisposeCallback(),ce){let re=()=>{delete v.__boundDepthTexture,delete v.__depthDisposeCallback,ce.removeEventListener("dispose",re)};ce.addEventListener("dispose",re),v.__depthDisposeCallback=re}v.__boundDepthTexture=ce}if(A.depthTexture&&!v.__autoAllocateDepthBuffer)if(G)for(let ce=0;ce<6;ce++)pt(v.__webglFramebuffer[ce],A,ce);else A.texture.mipmaps.length>0?pt(v.__webglFramebuffer[0],A,0):pt(v.__webglFramebuffer,A,0);else if(G){v.__webglDepthbuffer=[];for(let ce=0;ce<6;ce++)if(t.bindFramebuffer(i.FRAMEBUFFER,v.__webglFramebuffer[ce]),v.__webglDepthbuffer[ce]===void 0)v.__webglDepthbuffer[ce]=i.createRenderbuffer(),un(v.__webglDepthbuffer[ce],A,!1);else{let re=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,de=v.__webglDepthbuffer[ce];i.bindRenderbuffer(i.RENDERBUFFER,de),i.framebufferRenderbuffer(i.FRAMEBUFFER,re,i.RENDERBUFFER,de)}}else if(A.texture.mipmaps.length>0?t.bindFramebuffer(i.FRAMEBUFFER,v.__webglFramebuffer[0]):t.bindFramebuffer(i.FRAMEBUFFER,v.__webglFramebuffer),v.__webglDepthbuffer===void 0)v.__webglDepthbuffer=i.createRenderbuffer(),un(v.__webglDepthbuffer,A,!1);else{let re=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,de=v.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,de),i.framebufferRenderbuffer(i.FRAMEBUFFER,re,i.RENDERBUFFER,de)}t.bindFramebuffer(i.FRAMEBUFFER,null)}function Zt(A,v,G){let ce=n.get(A);v!==void 0&&at(ce.__webglFramebuffer,A,A.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),G!==void 0&&$t(A)}function Kt(A){let v=A.texture,G=n.get(A),ce=n.get(v);A.addEventListener("dispose",$),X(A);let re=A.textures,de=A.isWebGLCubeRenderTarget===!0,pe=re.length>1;if(pe||(ce.__webglTexture===void 0&&(ce.__webglTexture=i.createTexture()),ce.__version=v.version,a.memory.textures++),de){G.__webglFramebuffer=[];for(let j=0;j<6;j++)if(v.mipmaps.length>0){G.__webglFramebuffer[j]=[];for(let ee=0;ee<v.mipmaps.length;ee++)G.__webglFramebuffer[j][ee]=i.createFramebuffer()}else G.__webglFramebuffer[j]=i.createFramebuffer()}else{if(v.mipmaps.length>0){G.__webglFramebuffer=[];for(let j=0;j<v.mipmaps.length;j++)G.__webglFramebuffer[j]=i.createFramebuffer()}else G.__webglFramebuffer=i.createFramebuffer();if(pe)for(let j=0,ee=re.length;j<ee;j++){let fe=n.get(re[j]);fe.__webglTexture===void 0&&(fe.__webglTexture=i.createTexture(),a.memory.textures++)}if(A.samples>0&&ye(A)===!1){G.__webglMultisampledFramebuffer=i.createFramebuffer(),G.__webglColorRenderbuffer=[],t.bindFramebuffer(i.FRAMEBUFFER,G.__webglMultisampledFramebuffer);for(let j=0;j<re.length;j++){let ee=re[j];G.__webglColorRenderbuffer[j]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,G.__webglColorRenderbuffer[j]);let fe=r.convert(ee.format,ee.colorSpace),L=r.convert(ee.type),ie=R(ee.internalFormat,fe,L,ee.normalized,ee.colorSpace,A.isXRRenderTarget===!0),m=lt(A);i.renderbufferStorageMultisample(i.RENDERBUFFER,m,ie,A.width,A.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+j,i.RENDERBUFFER,G.__webglColorRenderbuffer[j])}i.bindRenderbuffer(i.RENDERBUFFER,null),A.depthBuffer&&(G.__webglDepthRenderbuffer=i.createRenderbuffer(),un(G.__webglDepthRenderbuffer,A,!0)),t.bindFramebuffer(i.FRAMEBUFFER,null)}}if(de){t.bindTexture(i.TEXTURE_CUBE_MAP,ce.__webglTexture),je(i.TEXTURE_CUBE_MAP,v);for(let j=0;j<6;j++)if(v.mipmaps.length>0)for(let ee=0;ee<v.mipmaps.length;ee++)at(G.__webglFramebuffer[j][ee],A,v,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+j,ee);else at(G.__webglFramebuffer[j],A,v,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+j,0);P(v)?w(i.TEXTURE_CUBE_MAP):v.mipmaps.length>0&&i.texParameteri(i.TEXTURE_CUBE_MAP,i.TEXTURE_MAX_LEVEL,v.mipmaps.length-1),t.unbindTexture()}else if(pe){for(let j=0,ee=re.length;j<ee;j++){let fe=re[j],L=n.get(fe),ie=i.TEXTURE_2D;(A.isWebGL3DRenderTarget||A.isWebGLArrayRenderTarget)&&(ie=A.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(ie,L.__webglTexture),je(ie,fe),at(G.__webglFramebuffer,A,fe,i.COLOR_ATTACHMENT0+j,ie,0),P(fe)&&w(ie)}t.unbindTexture()}else{let j=i.TEXTURE_2D;if((A.isWebGL3DRenderTarget||A.isWebGLArrayRenderTarget)&&(j=A.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),t.bindTexture(j,ce.__webglTexture),je(j,v),v.mipmaps.length>0)for(let ee=0;ee<v.mipmaps.length;ee++)at(G.__webglFramebuffer[ee],A,v,i.COLOR_ATTACHMENT0,j,ee);else at(G.__webglFramebuffer,A,v,i.COLOR_ATTACHMENT0,j,0);P(v)?w(j):v.mipmaps.length>0&&i.texParameteri(j,i.TEXTURE_MAX_LEVEL,v.mipmaps.length-1),t.unbindTexture()}A.depthBuffer&&$t(A)}function O(A){let v=A.textures;for(let G=0,ce=v.length;G<ce;G++){let re=v[G];if(P(re)&&re.mipmapsAutoUpdate===!0){let de=I(A),pe=n.get(re).__webglTexture;t.bindTexture(de,pe),w(de),t.unbindTexture()}}}let Jt=[];function ot(A){if(A.samples>0){if(ye(A)===!1){let v=A.textures,G=A.width,ce=A.height,re=i.COLOR_BUFFER_BIT,de=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,pe=n.get(A),j=v.length>1;if(j)for(let fe=0;fe<v.length;fe++)t.bindFramebuffer(i.FRAMEBUFFER,pe.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.RENDERBUFFER,null),t.bindFramebuffer(i.FRAMEBUFFER,pe.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.TEXTURE_2D,null,0);t.bindFramebuffer(i.READ_FRAMEBUFFER,pe.__webglMultisampledFramebuffer),A.texture.mipmaps.length>0?t.bindFramebuffer(i.DRAW_FRAMEBUFFER,pe.__webglFramebuffer[0]):t.bindFramebuffer(i.DRAW_FRAMEBUFFER,pe.__webglFramebuffer);for(let fe=0;fe<v.length;fe++){if(A.resolveDepthBuffer&&(A.depthBuffer&&(re|=i.DEPTH_BUFFER_BIT),A.stencilBuffer&&A.resolveStencilBuffer&&(re|=i.STENCIL_BUFFER_BIT)),j){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,pe.__webglColorRenderbuffer[fe]);let L=n.get(v[fe]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,L,0)}i.blitFramebuffer(0,0,G,ce,0,0,G,ce,re,i.NEAREST),l===!0&&(Jt.length=0,Jt.push(i.COLOR_ATTACHMENT0+fe),A.depthBuffer&&A.storeMultisampledDepthBuffer===!1&&Jt.push(de),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,Jt))}if(t.bindFramebuffer(i.READ_FRAMEBUFFER,null),t.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),j)for(let fe=0;fe<v.length;fe++){t.bindFramebuffer(i.FRAMEBUFFER,pe.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.RENDERBUFFER,pe.__webglColorRenderbuffer[fe]);let L=n.get(v[fe]).__webglTexture;t.bindFramebuffer(i.FRAMEBUFFER,pe.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+fe,i.TEXTURE_2D,L,0)}t.bindFramebuffer(i.DRAW_FRAMEBUFFER,pe.__webglMultisampledFramebuffer)}else if(A.depthBuffer&&A.storeMultisampledDepthBuffer===!1&&l){let v=A.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[v])}}}function lt(A){return Math.min(s.maxSamples,A.samples)}function ye(A){let v=n.get(A);return A.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&v.__useRenderToTexture!==!1}function _t(A){let v=a.render.frame;h.get(A)!==v&&(h.set(A,v),A.update())}function Le(A,v){let G=A.colorSpace,ce=A.format,re=A.type;return A.isCompressedTexture===!0||A.isVideoTexture===!0||G!==Js&&G!==En&&(Ke.getTransfer(G)===st?(ce!==wn||re!==en)&&Ne("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Oe("WebGLTextures: Unsupported texture color space:",G)),v}function Fe(A){return typeof HTMLImageElement<"u"&&A instanceof HTMLImageElement?(c.width=A.naturalWidth||A.width,c.height=A.naturalHeight||A.height):typeof VideoFrame<"u"&&A instanceof VideoFrame?(c.width=A.displayWidth,c.height=A.displayHeight):(c.width=A.width,c.height=A.height),c}this.allocateTextureUnit=ke,this.resetTextureUnits=oe,this.getTextureUnits=le,this.setTextureUnits=Re,this.setTexture2D=ve,this.setTexture2DArray=Me,this.setTexture3D=Pe,this.setTextureCube=_e,this.rebindTextures=Zt,this.setupRenderTarget=Kt,this.updateRenderTargetMipmap=O,this.updateMultisampleRenderTarget=ot,this.setupDepthRenderbuffer=$t,this.setupFrameBufferTexture=at,this.useMultisampledRTT=ye,this.dispose=J}function Ev(i,e){function t(n,s=En){let r,a=Ke.getTransfer(s);if(n===en)return i.UNSIGNED_BYTE;if(n===co)return i.UNSIGNED_SHORT_4_4_4_4;if(n===ho)return i.UNSIGNED_SHORT_5_5_5_1;if(n===mc)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===gc)return i.UNSIGNED_INT_10F_11F_11F_REV;if(n===fc)return i.BYTE;if(n===pc)return i.SHORT;if(n===Is)return i.UNSIGNED_SHORT;if(n===lo)return i.INT;if(n===Mn)return i.UNSIGNED_INT;if(n===Sn)return i.FLOAT;if(n===hn)return i.HALF_FLOAT;if(n===_c)return i.ALPHA;if(n===yc)return i.RGB;if(n===wn)return i.RGBA;if(n===Jn)return i.DEPTH_COMPONENT;if(n===ti)return i.DEPTH_STENCIL;if(n===vc)return i.RED;if(n===uo)return i.RED_INTEGER;if(n===Mi)return i.RG;if(n===fo)return i.RG_INTEGER;if(n===po)return i.RGBA_INTEGER;if(n===vr||n===xr||n===br||n===Mr)if(a===st)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===vr)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===xr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===br)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===Mr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===vr)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===xr)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===br)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===Mr)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===mo||n===go||n===_o||n===yo)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===mo)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===go)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===_o)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===yo)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===vo||n===xo||n===bo||n===Mo||n===So||n===Sr||n===wo)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(n===vo||n===xo)return a===st?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===bo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(n===Mo)return r.COMPRESSED_R11_EAC;if(n===So)return r.COMPRESSED_SIGNED_R11_EAC;if(n===Sr)return r.COMPRESSED_RG11_EAC;if(n===wo)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(n===Eo||n===Ao||n===To||n===Ro||n===Co||n===Po||n===Io||n===Lo||n===Do||n===No||n===Uo||n===Fo||n===Oo||n===Bo)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(n===Eo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Ao)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===To)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===Ro)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===Co)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Po)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===Io)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Lo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===Do)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===No)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===Uo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===Fo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===Oo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Bo)return a===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===ko||n===zo||n===Vo)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(n===ko)return a===st?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===zo)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Vo)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===Go||n===Ho||n===wr||n===Wo)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(n===Go)return r.COMPRESSED_RED_RGTC1_EXT;if(n===Ho)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===wr)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===Wo)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Gi?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:t}}var Av=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,Tv=`
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

}`,zc=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new lr(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new Ln({vertexShader:Av,fragmentShader:Tv,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new qt(new Oi(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},Vc=class extends bn{constructor(e,t){super();let n=this,s=null,r=1,a=null,o="local-floor",l=1,c=null,h=null,d=null,u=null,f=null,_=null,M=typeof XRWebGLBinding<"u",p=new zc,g={},S=t.getContextAttributes(),P=null,w=null,I=[],R=[],y=new Be,T=null,X=null,F=new Wt;F.viewport=new gt;let V=new Wt;V.viewport=new gt;let $=[F,V],Q=new ro,U=null,J=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(ne){let ve=I[ne];return ve===void 0&&(ve=new Ms,I[ne]=ve),ve.getTargetRaySpace()},this.getControllerGrip=function(ne){let ve=I[ne];return ve===void 0&&(ve=new Ms,I[ne]=ve),ve.getGripSpace()},this.getHand=function(ne){let ve=I[ne];return ve===void 0&&(ve=new Ms,I[ne]=ve),ve.getHandSpace()};function se(ne){let ve=R.indexOf(ne.inputSource);if(ve===-1)return;let Me=I[ve];Me!==void 0&&(Me.update(ne.inputSource,ne.frame,c||a),Me.dispatchEvent({type:ne.type,data:ne.inputSource}))}function Z(){s.removeEventListener("select",se),s.removeEventListener("selectstart",se),s.removeEventListener("selectend",se),s.removeEventListener("squeeze",se),s.removeEventListener("squeezestart",se),s.removeEventListener("squeezeend",se),s.removeEventListener("end",Z),s.removeEventListener("inputsourceschange",he);for(let ne=0;ne<I.length;ne++){let ve=R[ne];ve!==null&&(R[ne]=null,I[ne].disconnect(ve))}U=null,J=null,p.reset();for(let ne in g)delete g[ne];if(e.setRenderTarget(P),f=null,u=null,d=null,s=null,w=null,ke.stop(),n.isPresenting=!1,e.setPixelRatio(T),e.setSize(y.width,y.height,!1),X!==null){let ne=X.camera;ne.fov=X.fov,ne.zoom=X.zoom,ne.updateProjectionMatrix(),X=null}n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(ne){r=ne,n.isPresenting===!0&&Ne("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(ne){o=ne,n.isPresenting===!0&&Ne("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(ne){c=ne},this.getBaseLayer=function(){return u!==null?u:f},this.getBinding=function(){return d===null&&M&&(d=new XRWebGLBinding(s,t)),d},this.getFrame=function(){return _},this.getSession=function(){return s},this.setSession=async function(ne){if(s=ne,s!==null){if(P=e.getRenderTarget(),s.addEventListener("select",se),s.addEventListener("selectstart",se),s.addEventListener("selectend",se),s.addEventListener("squeeze",se),s.addEventListener("squeezestart",se),s.addEventListener("squeezeend",se),s.addEventListener("end",Z),s.addEventListener("inputsourceschange",he),S.xrCompatible!==!0&&await t.makeXRCompatible(),T=e.getPixelRatio(),e.getSize(y),M&&"createProjectionLayer"in XRWebGLBinding.prototype){let Me=null,Pe=null,_e=null;S.depth&&(_e=S.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,Me=S.stencil?ti:Jn,Pe=S.stencil?Gi:Mn);let Ue={colorFormat:t.RGBA8,depthFormat:_e,scaleFactor:r};d=this.getBinding(),u=d.createProjectionLayer(Ue),s.updateRenderState({layers:[u]}),e.setPixelRatio(1),e.setSize(u.textureWidth,u.textureHeight,!1),w=new ln(u.textureWidth,u.textureHeight,{format:wn,type:en,depthTexture:new Qn(u.textureWidth,u.textureHeight,Pe,void 0,void 0,void 0,void 0,void 0,void 0,Me),stencilBuffer:S.stencil,colorSpace:e.outputColorSpace,samples:S.antialias?4:0,resolveDepthBuffer:u.ignoreDepthValues===!1,resolveStencilBuffer:u.ignoreDepthValues===!1,storeMultisampledDepthBuffer:u.ignoreDepthValues===!1,storeMultisampledStencilBuffer:u.ignoreDepthValues===!1})}else{let Me={antialias:S.antialias,alpha:!0,depth:S.depth,stencil:S.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,t,Me),s.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),w=new ln(f.framebufferWidth,f.framebufferHeight,{format:wn,type:en,colorSpace:e.outputColorSpace,stencilBuffer:S.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}w.isXRRenderTarget=!0,this.setFoveation(l),c=null,a=await s.requestReferenceSpace(o),ke.setContext(s),ke.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return p.getDepthTexture()};function he(ne){for(let ve=0;ve<ne.removed.length;ve++){let Me=ne.removed[ve],Pe=R.indexOf(Me);Pe>=0&&(R[Pe]=null,I[Pe].disconnect(Me))}for(let ve=0;ve<ne.added.length;ve++){let Me=ne.added[ve],Pe=R.indexOf(Me);if(Pe===-1){for(let Ue=0;Ue<I.length;Ue++)if(Ue>=R.length){R.push(Me),Pe=Ue;break}else if(R[Ue]===null){R[Ue]=Me,Pe=Ue;break}if(Pe===-1)break}let _e=I[Pe];_e&&_e.connect(Me)}}function K(ne,ve){ve===null?ne.matrixWorld.copy(ne.matrix):ne.matrixWorld.multiplyMatrices(ve.matrixWorld,ne.matrix),ne.matrixWorldInverse.copy(ne.matrixWorld).invert()}this.updateCamera=function(ne){if(s===null)return;let ve=ne.near,Me=ne.far;p.texture!==null&&(p.depthNear>0&&(ve=p.depthNear),p.depthFar>0&&(Me=p.depthFar)),Q.near=V.near=F.near=ve,Q.far=V.far=F.far=Me,(U!==Q.near||J!==Q.far)&&(s.updateRenderState({depthNear:Q.near,depthFar:Q.far}),U=Q.near,J=Q.far),Q.layers.mask=ne.layers.mask|6,F.layers.mask=Q.layers.mask&-5,V.layers.mask=Q.layers.mask&-3;let Pe=ne.parent,_e=Q.cameras;K(Q,Pe);for(let Ue=0;Ue<_e.length;Ue++)K(_e[Ue],Pe);Q.projectionMatrix.copy(F.projectionMatrix),Q.projectionMatrixInverse.copy(F.projectionMatrixInverse),X===null&&ne.isPerspectiveCamera&&(X={camera:ne,fov:ne.fov,zoom:ne.zoom}),oe(ne,Q,Pe)};function oe(ne,ve,Me){Me===null?ne.matrix.copy(ve.matrixWorld):(ne.matrix.copy(Me.matrixWorld),ne.matrix.invert(),ne.matrix.multiply(ve.matrixWorld)),ne.matrix.decompose(ne.position,ne.quaternion,ne.scale),ne.updateMatrixWorld(!0),ne.projectionMatrix.copy(ve.projectionMatrix),ne.projectionMatrixInverse.copy(ve.projectionMatrixInverse),ne.isPerspectiveCamera&&(ne.fov=xs*2*Math.atan(1/ne.projectionMatrix.elements[5]),ne.zoom=1)}this.getCamera=function(){return Q},this.getFoveation=function(){if(!(u===null&&f===null))return l},this.setFoveation=function(ne){l=ne,u!==null&&(u.fixedFoveation=ne),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=ne)},this.hasDepthSensing=function(){return p.texture!==null},this.getDepthSensingMesh=function(){return p.getMesh(Q)},this.getCameraTexture=function(ne){return g[ne]};let le=null;function Re(ne,ve){if(h=ve.getViewerPose(c||a),_=ve,h!==null){let Me=h.views;f!==null&&(e.setRenderTargetFramebuffer(w,f.framebuffer),e.setRenderTarget(w));let Pe=!1;Me.length!==Q.cameras.length&&(Q.cameras.length=0,Pe=!0);for(let De=0;De<Me.length;De++){let je=Me[De],nt=null;if(f!==null)nt=f.getViewport(je);else{let Et=d.getViewSubImage(u,je);nt=Et.viewport,De===0&&(e.setRenderTargetTextures(w,Et.colorTexture,Et.depthStencilTexture),e.setRenderTarget(w))}let Xe=$[De];Xe===void 0&&(Xe=new Wt,Xe.layers.enable(De),Xe.viewport=new gt,$[De]=Xe),Xe.matrix.fromArray(je.transform.matrix),Xe.matrix.decompose(Xe.position,Xe.quaternion,Xe.scale),Xe.projectionMatrix.fromArray(je.projectionMatrix),Xe.projectionMatrixInverse.copy(Xe.projectionMatrix).invert(),Xe.viewport.set(nt.x,nt.y,nt.width,nt.height),De===0&&(Q.matrix.copy(Xe.matrix),Q.matrix.decompose(Q.position,Q.quaternion,Q.scale)),Pe===!0&&Q.cameras.push(Xe)}let _e=s.enabledFeatures;if(_e&&_e.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&M){d=n.getBinding();let De=d.getDepthInformation(Me[0]);De&&De.isValid&&De.texture&&p.init(De,s.renderState)}if(_e&&_e.includes("camera-access")&&M){e.state.unbindTexture(),d=n.getBinding();for(let De=0;De<Me.length;De++){let je=Me[De].camera;if(je){let nt=g[je];nt||(nt=new lr,g[je]=nt);let Xe=d.getCameraImage(je);nt.sourceTexture=Xe}}}}for(let Me=0;Me<I.length;Me++){let Pe=R[Me],_e=I[Me];Pe!==null&&_e!==void 0&&_e.update(Pe,ve,c||a)}le&&le(ne,ve),ve.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:ve}),_=null}let ke=new qd;ke.setAnimationLoop(Re),this.setAnimationLoop=function(ne){le=ne},this.dispose=function(){}}},Rv=new ut,nf=new ze;nf.set(-1,0,0,0,1,0,0,0,1);function Cv(i,e){function t(p,g){p.matrixAutoUpdate===!0&&p.updateMatrix(),g.value.copy(p.matrix)}function n(p,g){g.color.getRGB(p.fogColor.value,Rc(i)),g.isFog?(p.fogNear.value=g.near,p.fogFar.value=g.far):g.isFogExp2&&(p.fogDensity.value=g.density)}function s(p,g,S,P,w){g.isNodeMaterial?g.uniformsNeedUpdate=!1:g.isMeshBasicMaterial?r(p,g):g.isMeshLambertMaterial?(r(p,g),g.envMap&&(p.envMapIntensity.value=g.envMapIntensity)):g.isMeshToonMaterial?(r(p,g),d(p,g)):g.isMeshPhongMaterial?(r(p,g),h(p,g),g.envMap&&(p.envMapIntensity.value=g.envMapIntensity)):g.isMeshStandardMaterial?(r(p,g),u(p,g),g.isMeshPhysicalMaterial&&f(p,g,w)):g.isMeshMatcapMaterial?(r(p,g),_(p,g)):g.isMeshDepthMaterial?r(p,g):g.isMeshDistanceMaterial?(r(p,g),M(p,g)):g.isMeshNormalMaterial?r(p,g):g.isLineBasicMaterial?(a(p,g),g.isLineDashedMaterial&&o(p,g)):g.isPointsMaterial?l(p,g,S,P):g.isSpriteMaterial?c(p,g):g.isShadowMaterial?(p.color.value.copy(g.color),p.opacity.value=g.opacity):g.isShaderMaterial&&(g.uniformsNeedUpdate=!1)}function r(p,g){p.opacity.value=g.opacity,g.color&&p.diffuse.value.copy(g.color),g.emissive&&p.emissive.value.copy(g.emissive).multiplyScalar(g.emissiveIntensity),g.map&&(p.map.value=g.map,t(g.map,p.mapTransform)),g.alphaMap&&(p.alphaMap.value=g.alphaMap,t(g.alphaMap,p.alphaMapTransform)),g.bumpMap&&(p.bumpMap.value=g.bumpMap,t(g.bumpMap,p.bumpMapTransform),p.bumpScale.value=g.bumpScale,g.side===Yt&&(p.bumpScale.value*=-1)),g.normalMap&&(p.normalMap.value=g.normalMap,t(g.normalMap,p.normalMapTransform),p.normalScale.value.copy(g.normalScale),g.side===Yt&&p.normalScale.value.negate()),g.displacementMap&&(p.displacementMap.value=g.displacementMap,t(g.displacementMap,p.displacementMapTransform),p.displacementScale.value=g.displacementScale,p.displacementBias.value=g.displacementBias),g.emissiveMap&&(p.emissiveMap.value=g.emissiveMap,t(g.emissiveMap,p.emissiveMapTransform)),g.specularMap&&(p.specularMap.value=g.specularMap,t(g.specularMap,p.specularMapTransform)),g.alphaTest>0&&(p.alphaTest.value=g.alphaTest);let S=e.get(g),P=S.envMap,w=S.envMapRotation;P&&(p.envMap.value=P,p.envMapRotation.value.setFromMatrix4(Rv.makeRotationFromEuler(w)).transpose(),P.isCubeTexture&&P.isRenderTargetTexture===!1&&p.envMapRotation.value.premultiply(nf),p.reflectivity.value=g.reflectivity,p.ior.value=g.ior,p.refractionRatio.value=g.refractionRatio),g.lightMap&&(p.lightMap.value=g.lightMap,p.lightMapIntensity.value=g.lightMapIntensity,t(g.lightMap,p.lightMapTransform)),g.aoMap&&(p.aoMap.value=g.aoMap,p.aoMapIntensity.value=g.aoMapIntensity,t(g.aoMap,p.aoMapTransform))}function a(p,g){p.diffuse.value.copy(g.color),p.opacity.value=g.opacity,g.map&&(p.map.value=g.map,t(g.map,p.mapTransform))}function o(p,g){p.dashSize.value=g.dashSize,p.totalSize.value=g.dashSize+g.gapSize,p.scale.value=g.scale}function l(p,g,S,P){p.diffuse.value.copy(g.color),p.opacity.value=g.opacity,p.size.value=g.size*S,p.scale.value=P*.5,g.map&&(p.map.value=g.map,t(g.map,p.uvTransform)),g.alphaMap&&(p.alphaMap.value=g.alphaMap,t(g.alphaMap,p.alphaMapTransform)),g.alphaTest>0&&(p.alphaTest.value=g.alphaTest)}function c(p,g){p.diffuse.value.copy(g.color),p.opacity.value=g.opacity,p.rotation.value=g.rotation,g.map&&(p.map.value=g.map,t(g.map,p.mapTransform)),g.alphaMap&&(p.alphaMap.value=g.alphaMap,t(g.alphaMap,p.alphaMapTransform)),g.alphaTest>0&&(p.alphaTest.value=g.alphaTest)}function h(p,g){p.specular.value.copy(g.specular),p.shininess.value=Math.max(g.shininess,1e-4)}function d(p,g){g.gradientMap&&(p.gradientMap.value=g.gradientMap)}function u(p,g){p.metalness.value=g.metalness,g.metalnessMap&&(p.metalnessMap.value=g.metalnessMap,t(g.metalnessMap,p.metalnessMapTransform)),p.roughness.value=g.roughness,g.roughnessMap&&(p.roughnessMap.value=g.roughnessMap,t(g.roughnessMap,p.roughnessMapTransform)),g.envMap&&(p.envMapIntensity.value=g.envMapIntensity)}function f(p,g,S){p.ior.value=g.ior,g.diffuseRoughness>0&&(p.diffuseRoughness.value=g.diffuseRoughness,g.diffuseRoughnessMap&&(p.diffuseRoughnessMap.value=g.diffuseRoughnessMap,t(g.diffuseRoughnessMap,p.diffuseRoughnessMapTransform))),g.sheen>0&&(p.sheenColor.value.copy(g.sheenColor).multiplyScalar(g.sheen),p.sheenRoughness.value=g.sheenRoughness,g.sheenColorMap&&(p.sheenColorMap.value=g.sheenColorMap,t(g.sheenColorMap,p.sheenColorMapTransform)),g.sheenRoughnessMap&&(p.sheenRoughnessMap.value=g.sheenRoughnessMap,t(g.sheenRoughnessMap,p.sheenRoughnessMapTransform))),g.clearcoat>0&&(p.clearcoat.value=g.clearcoat,p.clearcoatRoughness.value=g.clearcoatRoughness,g.clearcoatMap&&(p.clearcoatMap.value=g.clearcoatMap,t(g.clearcoatMap,p.clearcoatMapTransform)),g.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=g.clearcoatRoughnessMap,t(g.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),g.clearcoatNormalMap&&(p.clearcoatNormalMap.value=g.clearcoatNormalMap,t(g.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(g.clearcoatNormalScale),g.side===Yt&&p.clearcoatNormalScale.value.negate())),g.dispersion>0&&(p.dispersion.value=g.dispersion),g.retroreflectivity>0&&(p.retroreflectivity.value=g.retroreflectivity),g.iridescence>0&&(p.iridescence.value=g.iridescence,p.iridescenceIOR.value=g.iridescenceIOR,p.iridescenceThicknessMinimum.value=g.iridescenceThicknessMinimum,p.iridescenceThicknessMaximum.value=g.iridescenceThicknessMaximum,g.iridescenceMap&&(p.iridescenceMap.value=g.iridescenceMap,t(g.iridescenceMap,p.iridescenceMapTransform)),g.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=g.iridescenceThicknessMap,t(g.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),g.transmission>0&&(p.transmission.value=g.transmission,p.transmissionSamplerMap.value=S.texture,p.transmissionSamplerSize.value.set(S.width,S.height),g.transmissionMap&&(p.transmissionMap.value=g.transmissionMap,t(g.transmissionMap,p.transmissionMapTransform)),p.thickness.value=g.thickness,g.thicknessMap&&(p.thicknessMap.value=g.thicknessMap,t(g.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=g.attenuationDistance,p.attenuationColor.value.copy(g.attenuationColor)),g.anisotropy>0&&(p.anisotropyVector.value.set(g.anisotropy*Math.cos(g.anisotropyRotation),g.anisotropy*Math.sin(g.anisotropyRotation)),g.anisotropyMap&&(p.anisotropyMap.value=g.anisotropyMap,t(g.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=g.specularIntensity,p.specularColor.value.copy(g.specularColor),g.specularColorMap&&(p.specularColorMap.value=g.specularColorMap,t(g.specularColorMap,p.specularColorMapTransform)),g.specularIntensityMap&&(p.specularIntensityMap.value=g.specularIntensityMap,t(g.specularIntensityMap,p.specularIntensityMapTransform))}function _(p,g){g.matcap&&(p.matcap.value=g.matcap)}function M(p,g){let S=e.get(g).light;p.referencePosition.value.setFromMatrixPosition(S.matrixWorld),p.nearDistance.value=S.shadow.camera.near,p.farDistance.value=S.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function Pv(i,e,t,n){let s={},r={};function a(S,P){let w=P.program;n.uniformBlockBinding(S,w,s[S.id])}function o(S,P){let w=s[S.id];w===void 0&&(_(S),w=l(S),s[S.id]=w,S.addEventListener("dispose",p));let I=P.program;n.updateUBOMapping(S,I);let R=e.render.frame;r[S.id]!==R&&(c(S),r[S.id]=R)}function l(S){let P=i.createBuffer(),w=S.__size,I=S.usage;return i.bindBuffer(i.UNIFORM_BUFFER,P),i.bufferData(i.UNIFORM_BUFFER,w,I),i.bindBuffer(i.UNIFORM_BUFFER,null),P}function c(S){let P=s[S.id],w=S.uniforms,I=S.__cache;i.bindBuffer(i.UNIFORM_BUFFER,P);for(let R=0,y=w.length;R<y;R++){let T=w[R];if(Array.isArray(T))for(let X=0,F=T.length;X<F;X++)h(T[X],R,X,I);else h(T,R,0,I)}i.bindBuffer(i.UNIFORM_BUFFER,null)}function h(S,P,w,I){if(u(S,P,w,I)===!0){let R=S.__offset,y=S.value;if(Array.isArray(y)){let T=0;for(let X=0;X<y.length;X++){let F=y[X],V=M(F,!0);d(F,S.__data,T),T+=V.storage/Float32Array.BYTES_PER_ELEMENT}}else d(y,S.__data,0);i.bufferSubData(i.UNIFORM_BUFFER,R,S.__data)}}function d(S,P,w){typeof S=="number"||typeof S=="boolean"?P[w]=S:S.isMatrix3?(P[w]=S.elements[0],P[w+1]=S.elements[1],P[w+2]=S.elements[2],P[w+3]=0,P[w+4]=S.elements[3],P[w+5]=S.elements[4],P[w+6]=S.elements[5],P[w+7]=0,P[w+8]=S.elements[6],P[w+9]=S.elements[7],P[w+10]=S.elements[8],P[w+11]=0):ArrayBuffer.isView(S)?P.set(S.subarray(0,P.length-w),w):S.toArray(P,w)}function u(S,P,w,I){let R=S.value,y=P+"_"+w;if(Array.isArray(R)){I[y]===void 0&&(I[y]=[]);let T=I[y],X=!1;for(let F=0;F<R.length;F++)f(R[F],T,F)===!0&&(X=!0);return X}return f(R,I,y)}function f(S,P,w){if(P[w]===void 0)return typeof S=="number"||typeof S=="boolean"?P[w]=S:ArrayBuffer.isView(S)?P[w]=S.slice():P[w]=S.clone(),!0;{let I=P[w];if(typeof S=="number"||typeof S=="boolean"){if(I!==S)return P[w]=S,!0}else{if(ArrayBuffer.isView(S))return!0;if(I.equals(S)===!1)return I.copy(S),!0}}return!1}function _(S){let P=S.uniforms,w=0,I=16;for(let y=0,T=P.length;y<T;y++){let X=Array.isArray(P[y])?P[y]:[P[y]];for(let F=0,V=X.length;F<V;F++){let $=X[F],Q=Array.isArray($.value)?$.value:[$.value],U=Array.isArray(P[y])||Array.isArray($.value),J=w;for(let Z=0,he=Q.length;Z<he;Z++){let K=Q[Z],oe=M(K,U),le=w%I,Re=le%oe.boundary,ke=le+Re;w+=Re,ke!==0&&I-ke<oe.storage&&(w+=I-ke),Z===0&&(J=w),w+=oe.storage}let se=$.type==="int"?Int32Array:$.type==="uint"?Uint32Array:Float32Array;$.__data=new se((w-J)/Float32Array.BYTES_PER_ELEMENT),$.__offset=J}}let R=w%I;return R>0&&(w+=I-R),S.__size=w,S.__cache={},this}function M(S,P){let w={boundary:0,storage:0};return typeof S=="number"||typeof S=="boolean"?(w.boundary=4,w.storage=4):S.isVector2?(w.boundary=8,w.storage=8):S.isVector3||S.isColor?(w.boundary=16,w.storage=12):S.isVector4?(w.boundary=16,w.storage=16):S.isMatrix3?(w.boundary=16,w.storage=48):S.isMatrix4?(w.boundary=16,w.storage=64):S.isTexture?Ne("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(S)?(w.boundary=16,w.storage=S.byteLength):Ne("WebGLRenderer: Unsupported uniform value type.",S),P===!0&&(w.boundary=16,w.storage=Math.ceil(w.storage/16)*16),w}function p(S){let P=S.target;P.removeEventListener("dispose",p),i.deleteBuffer(s[P.id]),delete s[P.id],delete r[P.id]}function g(){for(let S in s)i.deleteBuffer(s[S]);s={},r={}}return{bind:a,update:o,dispose:g}}var Iv=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),On=null;function Lv(){return On===null&&(On=new Fi(Iv,16,16,Mi,hn),On.name="DFG_LUT",On.minFilter=wt,On.magFilter=wt,On.wrapS=Cn,On.wrapT=Cn,On.generateMipmaps=!1,On.needsUpdate=!0),On}var $o=class{constructor(e={}){let{canvas:t=md(),context:n=null,depth:s=!0,stencil:r=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:d=!1,reversedDepthBuffer:u=!1,outputBufferType:f=en}=e;this.isWebGLRenderer=!0;let _;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");_=n.getContextAttributes().alpha}else _=a;let M=f,p=new Set([po,fo,uo]),g=new Set([en,Mn,Is,Gi,co,ho]),S=new Uint32Array(4),P=new Int32Array(4),w={textures:[],min:[],max:[],resolution:[]},I=null,R=null,y=[],T=[],X=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=Un,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let F=this,V=!1,$=null,Q=null,U=null,J=null;this._outputColorSpace=kt;let se=0,Z=0,he=null,K=-1,oe=null,le=new gt,Re=new gt,ke=null,ne=new Ge(0),ve=0,Me=t.width,Pe=t.height,_e=1,Ue=null,dt=null,De=new gt(0,0,Me,Pe),je=new gt(0,0,Me,Pe),nt=!1,Xe=new gi,Et=new Wa,vt=!1,Lt=!1,at=new ut,un=new z,pt=new gt,$t={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},Zt=!1;function Kt(){return he===null?_e:1}let O=n;function Jt(x,N){return t.getContext(x,N)}let ot,lt,ye,_t,Le,Fe,A,v,G,ce,re,de,pe,j,ee,fe,L,ie,m,b,E,C,D;try{let x={alpha:!0,depth:s,stencil:r,antialias:o,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:h,failIfMajorPerformanceCaveat:d};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",q,!1),t.addEventListener("webglcontextrestored",ae,!1),t.addEventListener("webglcontextcreationerror",te,!1),O===null){let N="webgl2";if(O=Jt(N,x),O===null)throw Jt(N)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}k()}catch(x){throw t.removeEventListener("webglcontextlost",q,!1),t.removeEventListener("webglcontextrestored",ae,!1),t.removeEventListener("webglcontextcreationerror",te,!1),Oe("WebGLRenderer: "+x.message),x}function k(){ot=new H_(O),ot.init(),E=new Ev(O,ot),lt=new L_(O,ot,e,E),ye=new Sv(O,ot),lt.reversedDepthBuffer&&u&&ye.buffers.depth.setReversed(!0),Q=O.createFramebuffer(),U=O.createFramebuffer(),J=O.createFramebuffer(),_t=new q_(O),Le=new cv,Fe=new wv(O,ot,ye,Le,lt,E,_t),A=new G_(F),v=new $m(O),C=new P_(O,v),G=new W_(O,v,_t,C),ce=new $_(O,G,v,C,_t),ie=new Y_(O,lt,Fe),ee=new D_(Le),re=new lv(F,A,ot,lt,C,ee),de=new Cv(F,Le),pe=new uv,j=new _v(ot),L=new C_(F,A,ye,ce,_,l),fe=new Mv(F,ce,lt),D=new Pv(O,_t,lt,ye),m=new I_(O,ot,_t),b=new X_(O,ot,_t),_t.programs=re.programs,F.capabilities=lt,F.extensions=ot,F.properties=Le,F.renderLists=pe,F.shadowMap=fe,F.state=ye,F.info=_t}M!==en&&(X=new K_(M,t.width,t.height,o,s,r));let B=new Vc(F,O);this.xr=B,this.getContext=function(){return O},this.getContextAttributes=function(){return O.getContextAttributes()},this.forceContextLoss=function(){let x=ot.get("WEBGL_lose_context");x&&x.loseContext()},this.forceContextRestore=function(){let x=ot.get("WEBGL_lose_context");x&&x.restoreContext()},this.getPixelRatio=function(){return _e},this.setPixelRatio=function(x){x!==void 0&&(_e=x,this.setSize(Me,Pe,!1))},this.getSize=function(x){return x.set(Me,Pe)},this.setSize=function(x,N,Y=!0){if(B.isPresenting){Ne("WebGLRenderer: Can't change size while VR device is presenting.");return}Me=x,Pe=N,t.width=Math.floor(x*_e),t.height=Math.floor(N*_e),Y===!0&&(t.style.width=x+"px",t.style.height=N+"px"),X!==null&&X.setSize(t.width,t.height),this.setViewport(0,0,x,N)},this.getDrawingBufferSize=function(x){return x.set(Me*_e,Pe*_e).floor()},this.setDrawingBufferSize=function(x,N,Y){Me=x,Pe=N,_e=Y,t.width=Math.floor(x*Y),t.height=Math.floor(N*Y),this.setViewport(0,0,x,N)},this.setEffects=function(x){if(M===en){Oe("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(x){for(let N=0;N<x.length;N++)if(x[N].isOutputPass===!0){Ne("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}X.setEffects(x||[])},this.getCurrentViewport=function(x){return x.copy(le)},this.getViewport=function(x){return x.copy(De)},this.setViewport=function(x,N,Y,H){x.isVector4?De.set(x.x,x.y,x.z,x.w):De.set(x,N,Y,H),ye.viewport(le.copy(De).multiplyScalar(Kt()).round())},this.getScissor=function(x){return x.copy(je)},this.setScissor=function(x,N,Y,H){x.isVector4?je.set(x.x,x.y,x.z,x.w):je.set(x,N,Y,H),ye.scissor(Re.copy(je).multiplyScalar(Kt()).round())},this.getScissorTest=function(){return nt},this.setScissorTest=function(x){ye.setScissorTest(nt=x)},this.setOpaqueSort=function(x){Ue=x},this.setTransparentSort=function(x){dt=x},this.getClearColor=function(x){return x.copy(L.getClearColor())},this.setClearColor=function(){L.setClearColor(...arguments)},this.getClearAlpha=function(){return L.getClearAlpha()},this.setClearAlpha=function(){L.setClearAlpha(...arguments)},this.clear=function(x=!0,N=!0,Y=!0){let H=0;if(x){let W=!1;if(he!==null){let ge=he.texture.format;W=p.has(ge)}if(W){let ge=he.texture.type,Ee=g.has(ge),me=L.getClearColor(),be=L.getClearAlpha(),Ce=me.r,Ve=me.g,$e=me.b;Ee?(S[0]=Ce,S[1]=Ve,S[2]=$e,S[3]=be,O.clearBufferuiv(O.COLOR,0,S)):(P[0]=Ce,P[1]=Ve,P[2]=$e,P[3]=be,O.clearBufferiv(O.COLOR,0,P))}else H|=O.COLOR_BUFFER_BIT}N&&(H|=O.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),Y&&(H|=O.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),H!==0&&O.clear(H)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(x){x.setRenderer(this),$=x},this.dispose=function(){t.removeEventListener("webglcontextlost",q,!1),t.removeEventListener("webglcontextrestored",ae,!1),t.removeEventListener("webglcontextcreationerror",te,!1),L.dispose(),pe.dispose(),j.dispose(),Fe.dispose(),Le.dispose(),A.dispose(),ce.dispose(),G.dispose(),C.dispose(),D.dispose(),re.dispose(),B.dispose(),B.removeEventListener("sessionstart",we),B.removeEventListener("sessionend",ct),Gt.stop()};function q(x){x.preventDefault(),wc("WebGLRenderer: Context Lost."),V=!0}function ae(){wc("WebGLRenderer: Context Restored."),V=!1;let x=_t.autoReset,N=fe.enabled,Y=fe.autoUpdate,H=fe.needsUpdate,W=fe.type;k(),_t.autoReset=x,fe.enabled=N,fe.autoUpdate=Y,fe.needsUpdate=H,fe.type=W}function te(x){Oe("WebGLRenderer: A WebGL context could not be created. Reason: ",x.statusMessage)}function ue(x){let N=x.target;N.removeEventListener("dispose",ue),Se(N)}function Se(x){qe(x),Le.remove(x)}function qe(x){let N=Le.get(x).programs;N!==void 0&&(N.forEach(function(Y){re.releaseProgram(Y)}),x.isShaderMaterial&&re.releaseShaderCache(x))}this.renderBufferDirect=function(x,N,Y,H,W,ge){N===null&&(N=$t);let Ee=W.isMesh&&W.matrixWorld.determinantAffine()<0,me=Pf(x,N,Y,H,W);ye.setMaterial(H,Ee);let be=Y.index,Ce=1;if(H.wireframe===!0){if(be=G.getWireframeAttribute(Y),be===void 0)return;Ce=2}let Ve=Y.drawRange,$e=Y.attributes.position,Ae=Ve.start*Ce,Ze=(Ve.start+Ve.count)*Ce;ge!==null&&(Ae=Math.max(Ae,ge.start*Ce),Ze=Math.min(Ze,(ge.start+ge.count)*Ce)),be!==null?(Ae=Math.max(Ae,0),Ze=Math.min(Ze,be.count)):$e!=null&&(Ae=Math.max(Ae,0),Ze=Math.min(Ze,$e.count));let Mt=Ze-Ae;if(Mt<0||Mt===1/0)return;C.setup(W,H,me,Y,be);let ht,rt=m;if(be!==null&&(ht=v.get(be),rt=b,rt.setIndex(ht)),W.isMesh)H.wireframe===!0?(ye.setLineWidth(H.wireframeLinewidth*Kt()),rt.setMode(O.LINES)):rt.setMode(O.TRIANGLES);else if(W.isLine){let Ut=H.linewidth;Ut===void 0&&(Ut=1),ye.setLineWidth(Ut*Kt()),W.isLineSegments?rt.setMode(O.LINES):W.isLineLoop?rt.setMode(O.LINE_LOOP):rt.setMode(O.LINE_STRIP)}else W.isPoints?rt.setMode(O.POINTS):W.isSprite&&rt.setMode(O.TRIANGLES);if(W.isBatchedMesh)if(ot.get("WEBGL_multi_draw"))rt.renderMultiDraw(W._multiDrawStarts,W._multiDrawCounts,W._multiDrawCount);else{let Ut=W._multiDrawStarts,Te=W._multiDrawCounts,Ht=W._multiDrawCount,Qe=be?v.get(be).bytesPerElement:1,Si=Le.get(H).currentProgram.getUniforms();for(let Ft=0;Ft<Ht;Ft++)Si.setValue(O,"_gl_DrawID",Ft),rt.render(Ut[Ft]/Qe,Te[Ft])}else if(W.isInstancedMesh)rt.renderInstances(Ae,Mt,W.count);else if(Y.isInstancedBufferGeometry){let Ut=Y._maxInstanceCount!==void 0?Y._maxInstanceCount:1/0,Te=Math.min(Y.instanceCount,Ut);rt.renderInstances(Ae,Mt,Te)}else rt.render(Ae,Mt)};function it(x,N,Y,H){$!==null&&x.isNodeMaterial&&$.setObject(H,x),vt===!0&&ee.setState(x,Y,!1),x.transparent===!0&&x.side===Qt&&x.forceSinglePass===!1?(x.side=Yt,x.needsUpdate=!0,ks(x,N,H),x.side=Nn,x.needsUpdate=!0,ks(x,N,H),x.side=Qt):ks(x,N,H)}this.compile=function(x,N,Y=null){Y===null&&(Y=x),$!==null&&$.renderStart(x,N,Y),R=j.get(Y),R.init(N),T.push(R),Y.traverseVisible(function(W){W.isLight&&W.layers.test(N.layers)&&(R.pushLight(W),W.castShadow&&R.pushShadow(W))}),x!==Y&&x.traverseVisible(function(W){W.isLight&&W.layers.test(N.layers)&&(R.pushLight(W),W.castShadow&&R.pushShadow(W))}),R.setupLights(),$!==null&&$.updateLights(R.state.lightsArray),Lt=this.localClippingEnabled,vt=ee.init(this.clippingPlanes,Lt),vt===!0&&ee.setGlobalState(this.clippingPlanes,N),$!==null&&fe.render(R.state.shadowsArray,Y,N);let H=new Set;return x.traverse(function(W){if(!(W.isMesh||W.isPoints||W.isLine||W.isSprite))return;let ge=W.material;if(ge)if(Array.isArray(ge))for(let Ee=0;Ee<ge.length;Ee++){let me=ge[Ee];it(me,Y,N,W),H.add(me)}else it(ge,Y,N,W),H.add(ge)}),R=T.pop(),$!==null&&$.renderEnd(),H},this.compileAsync=function(x,N,Y=null){let H=this.compile(x,N,Y);return new Promise(W=>{function ge(){if(H.forEach(function(Ee){let be=Le.get(Ee).currentProgram;(be===void 0||be.isReady())&&H.delete(Ee)}),H.size===0){W(x);return}setTimeout(ge,10)}ot.get("KHR_parallel_shader_compile")!==null?ge():setTimeout(ge,10)})};let Ye=null;function mt(x){Ye&&Ye(x)}function we(){Gt.stop()}function ct(){Gt.start()}let Gt=new qd;Gt.setAnimationLoop(mt),typeof self<"u"&&Gt.setContext(self),this.setAnimationLoop=function(x){Ye=x,B.setAnimationLoop(x),x===null?Gt.stop():Gt.start()},B.addEventListener("sessionstart",we),B.addEventListener("sessionend",ct),this.render=function(x,N){if(N!==void 0&&N.isCamera!==!0){Oe("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(V===!0)return;$!==null&&$.renderStart(x,N);let Y=B.enabled===!0&&B.isPresenting===!0,H=X!==null&&(he===null||Y)&&X.begin(F,he);if(x.matrixWorldAutoUpdate===!0&&x.updateMatrixWorld(),N.parent===null&&N.matrixWorldAutoUpdate===!0&&N.updateMatrixWorld(),B.enabled===!0&&B.isPresenting===!0&&(X===null||X.isCompositing()===!1)&&(B.cameraAutoUpdate===!0&&B.updateCamera(N),N=B.getCamera()),x.isScene===!0&&x.onBeforeRender(F,x,N,he),R=j.get(x,T.length),R.init(N),R.state.textureUnits=Fe.getTextureUnits(),T.push(R),at.multiplyMatrices(N.projectionMatrix,N.matrixWorldInverse),N.isArrayCamera?Et.setFromArrayCamera(N):Xe.setFromProjectionMatrix(at,pn,N.reversedDepth),Lt=this.localClippingEnabled,vt=ee.init(this.clippingPlanes,Lt),I=pe.get(x,y.length),I.init(),y.push(I),this.info.render.frame++,B.enabled===!0&&B.isPresenting===!0){let Ee=F.xr.getDepthSensingMesh();Ee!==null&&An(Ee,N,-1/0,F.sortObjects)}An(x,N,0,F.sortObjects),I.finish(),$!==null&&$.updateLights(R.state.lightsArray),F.sortObjects===!0&&I.sort(Ue,dt),Zt=B.enabled===!1||B.isPresenting===!1||B.hasDepthSensing()===!1,Zt&&L.addToRenderList(I,x),this.info.autoReset===!0&&this.info.reset(),vt===!0&&ee.beginShadows();let W=R.state.shadowsArray;if(fe.render(W,x,N),vt===!0&&ee.endShadows(),(H&&X.hasRenderPass())===!1){let Ee=I.opaque,me=I.transmissive;if(R.setupLights(),N.isArrayCamera){let be=N.cameras;if(me.length>0)for(let Ce=0,Ve=be.length;Ce<Ve;Ce++){let $e=be[Ce];Bs(Ee,me,x,$e)}Zt&&L.render(x);for(let Ce=0,Ve=be.length;Ce<Ve;Ce++){let $e=be[Ce];Os(I,x,$e,$e.viewport)}}else me.length>0&&Bs(Ee,me,x,N),Zt&&L.render(x),Os(I,x,N)}he!==null&&Z===0&&(Fe.updateMultisampleRenderTarget(he),Fe.updateRenderTargetMipmap(he)),H&&X.end(F),x.isScene===!0&&x.onAfterRender(F,x,N),C.resetDefaultState(),K=-1,oe=null,T.pop(),T.length>0?(R=T[T.length-1],Fe.setTextureUnits(R.state.textureUnits),vt===!0&&ee.setGlobalState(F.clippingPlanes,R.state.camera)):R=null,y.pop(),y.length>0?I=y[y.length-1]:I=null,$!==null&&$.renderEnd()};function An(x,N,Y,H){if(x.visible===!1)return;if(x.layers.test(N.layers)){if(x.isGroup)Y=x.renderOrder;else if(x.isLOD)x.autoUpdate===!0&&x.update(N);else if(x.isLight)R.pushLight(x),x.castShadow&&R.pushShadow(x);else if(x.isSprite){let Ee=N.isArrayCamera?Et:Xe;if(!x.frustumCulled||x.intersectsFrustum(Ee)){H&&pt.setFromMatrixPosition(x.matrixWorld).applyMatrix4(at);let me=ce.update(x),be=x.material;be.visible&&I.push(x,me,be,Y,pt.z,null,N)}}else if(x.isMesh||x.isLine||x.isPoints){let Ee=N.isArrayCamera?Et:Xe;if(!x.frustumCulled||x.intersectsFrustum(Ee)){let me=ce.update(x),be=x.material;if(H&&(x.boundingSphere!==void 0?(x.boundingSphere===null&&x.computeBoundingSphere(),pt.copy(x.boundingSphere.center)):(me.boundingSphere===null&&me.computeBoundingSphere(),pt.copy(me.boundingSphere.center)),pt.applyMatrix4(x.matrixWorld).applyMatrix4(at)),Array.isArray(be)){let Ce=me.groups;for(let Ve=0,$e=Ce.length;Ve<$e;Ve++){let Ae=Ce[Ve],Ze=be[Ae.materialIndex];Ze&&Ze.visible&&I.push(x,me,Ze,Y,pt.z,Ae,N)}}else be.visible&&I.push(x,me,be,Y,pt.z,null,N)}}}let ge=x.children;for(let Ee=0,me=ge.length;Ee<me;Ee++)An(ge[Ee],N,Y,H)}function Os(x,N,Y,H){let{opaque:W,transmissive:ge,transparent:Ee}=x;R.setupLightsView(Y),vt===!0&&ee.setGlobalState(F.clippingPlanes,Y),H&&ye.viewport(le.copy(H)),W.length>0&&Nr(W,N,Y),ge.length>0&&Nr(ge,N,Y),Ee.length>0&&Nr(Ee,N,Y),ye.buffers.depth.setTest(!0),ye.buffers.depth.setMask(!0),ye.buffers.color.setMask(!0),ye.setPolygonOffset(!1)}function Bs(x,N,Y,H){if((Y.isScene===!0?Y.overrideMaterial:null)!==null)return;if(R.state.transmissionRenderTarget[H.id]===void 0){let Ae=ot.has("EXT_color_buffer_half_float")||ot.has("EXT_color_buffer_float");R.state.transmissionRenderTarget[H.id]=new ln(1,1,{generateMipmaps:!0,type:Ae?hn:en,minFilter:ei,samples:Math.max(4,lt.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Ke.workingColorSpace})}let ge=R.state.transmissionRenderTarget[H.id],Ee=H.viewport||le;ge.setSize(Ee.z*F.transmissionResolutionScale,Ee.w*F.transmissionResolutionScale);let me=F.getRenderTarget(),be=F.getActiveCubeFace(),Ce=F.getActiveMipmapLevel();F.setRenderTarget(ge),F.getClearColor(ne),ve=F.getClearAlpha(),ve<1&&F.setClearColor(16777215,.5),F.clear(),Zt&&L.render(Y);let Ve=F.toneMapping;F.toneMapping=Un;let $e=H.viewport;if(H.viewport!==void 0&&(H.viewport=void 0),R.setupLightsView(H),vt===!0&&ee.setGlobalState(F.clippingPlanes,H),Nr(x,Y,H),Fe.updateMultisampleRenderTarget(ge),Fe.updateRenderTargetMipmap(ge),ot.has("WEBGL_multisampled_render_to_texture")===!1){let Ae=!1;for(let Ze=0,Mt=N.length;Ze<Mt;Ze++){let ht=N[Ze],{object:rt,geometry:Ut,material:Te,group:Ht}=ht;if(Te.side===Qt&&rt.layers.test(H.layers)){let Qe=Te.side;Te.side=Yt,Te.needsUpdate=!0,Zc(rt,Y,H,Ut,Te,Ht),Te.side=Qe,Te.needsUpdate=!0,Ae=!0}}Ae===!0&&(Fe.updateMultisampleRenderTarget(ge),Fe.updateRenderTargetMipmap(ge))}F.setRenderTarget(me,be,Ce),F.setClearColor(ne,ve),$e!==void 0&&(H.viewport=$e),F.toneMapping=Ve}function Nr(x,N,Y){let H=N.isScene===!0?N.overrideMaterial:null;for(let W=0,ge=x.length;W<ge;W++){let Ee=x[W],{object:me,geometry:be,group:Ce}=Ee,Ve=Ee.material;Ve.allowOverride===!0&&H!==null&&(Ve=H),me.layers.test(Y.layers)&&Zc(me,N,Y,be,Ve,Ce)}}function Zc(x,N,Y,H,W,ge){$!==null&&W.isNodeMaterial&&$.setObject(x,W),x.onBeforeRender(F,N,Y,H,W,ge),x.modelViewMatrix.multiplyMatrices(Y.matrixWorldInverse,x.matrixWorld),x.normalMatrix.getNormalMatrix(x.modelViewMatrix),W.onBeforeRender(F,N,Y,H,x,ge),W.transparent===!0&&W.side===Qt&&W.forceSinglePass===!1?(W.side=Yt,W.needsUpdate=!0,F.renderBufferDirect(Y,N,H,W,x,ge),W.side=Nn,W.needsUpdate=!0,F.renderBufferDirect(Y,N,H,W,x,ge),W.side=Qt):F.renderBufferDirect(Y,N,H,W,x,ge),x.onAfterRender(F,N,Y,H,W,ge)}function Kc(x){let N=0;for(let Y of x)Y.texture!==null&&N++;return N}function ks(x,N,Y){N.isScene!==!0&&(N=$t);let H=Le.get(x),W=R.state.lights,ge=R.state.shadowsArray,Ee=W.state.version,me=re.getParameters(x,W.state,ge,N,Y,R.state.lightProbeGridArray),be=re.getProgramCacheKey(me),Ce=H.programs;H.environment=x.isMeshStandardMaterial||x.isMeshLambertMaterial||x.isMeshPhongMaterial?N.environment:null,H.fog=N.fog;let Ve=x.isMeshStandardMaterial||x.isMeshLambertMaterial&&!x.envMap||x.isMeshPhongMaterial&&!x.envMap;H.envMap=A.get(x.envMap||H.environment,Ve),H.envMapRotation=H.environment!==null&&x.envMap===null?N.environmentRotation:x.envMapRotation,Ce===void 0&&(x.addEventListener("dispose",ue),Ce=new Map,H.programs=Ce,H.programVariants=new Map);let $e=Ce.get(be);if($e!==void 0){if(H.currentProgram===$e&&H.lightsStateVersion===Ee)return jc(x,me),$e}else me.uniforms=re.getUniforms(x),$!==null&&x.isNodeMaterial&&$.build(x,Y,me),x.onBeforeCompile(me,F),$e=re.acquireProgram(me,be),Ce.set(be,$e),H.uniforms=me.uniforms;let Ae=H.uniforms;return(!x.isShaderMaterial&&!x.isRawShaderMaterial||x.clipping===!0)&&(Ae.clippingPlanes=ee.uniform),jc(x,me),H.needsLights=Lf(x),H.lightsStateVersion=Ee,H.needsLights&&(Ae.ambientLightColor.value=W.state.ambient,Ae.lightProbe.value=W.state.probe,Ae.sunLights.value=W.state.sun,Ae.sunLightShadows.value=W.state.sunShadow,Ae.directionalLights.value=W.state.directional,Ae.directionalLightShadows.value=W.state.directionalShadow,Ae.spotLights.value=W.state.spot,Ae.spotLightShadows.value=W.state.spotShadow,Ae.rectAreaLights.value=W.state.rectArea,Ae.ltc_1.value=W.state.rectAreaLTC1,Ae.ltc_2.value=W.state.rectAreaLTC2,Ae.pointLights.value=W.state.point,Ae.pointLightShadows.value=W.state.pointShadow,Ae.hemisphereLights.value=W.state.hemi,Ae.sunShadowMatrix.value=W.state.sunShadowMatrix,Ae.sunShadowCascade.value=W.state.sunShadowCascade,Ae.directionalShadowMatrix.value=W.state.directionalShadowMatrix,Ae.spotLightMatrix.value=W.state.spotLightMatrix,Ae.spotLightMap.value=W.state.spotLightMap,Ae.pointShadowMatrix.value=W.state.pointShadowMatrix),H.numLightProbeGrids=Kc(R.state.lightProbeGridArray),H.currentProgram=$e,H.uniformsList=null,$e}function Cf(x,N,Y,H,W){let ge=Le.get(x),Ee=ge.currentProgram.id+","+H+","+W,me=ge.programVariants.get(Ee);return me===void 0?(me=ks(x,N,Y),ge.programVariants.set(Ee,me)):(ge.currentProgram=me,ge.uniformsList=null,ge.outputColorSpace=H,ge.toneMapping=W),me}function Jc(x){if(x.uniformsList===null){let N=x.currentProgram.getUniforms();x.uniformsList=Ds.seqWithValue(N.seq,x.uniforms)}return x.uniformsList}function jc(x,N){let Y=Le.get(x);Y.outputColorSpace=N.outputColorSpace,Y.batching=N.batching,Y.batchingColor=N.batchingColor,Y.instancing=N.instancing,Y.instancingColor=N.instancingColor,Y.instancingMorph=N.instancingMorph,Y.skinning=N.skinning,Y.morphTargets=N.morphTargets,Y.morphNormals=N.morphNormals,Y.morphColors=N.morphColors,Y.morphTargetsCount=N.morphTargetsCount,Y.numClippingPlanes=N.numClippingPlanes,Y.numIntersection=N.numClipIntersection,Y.vertexAlphas=N.vertexAlphas,Y.vertexTangents=N.vertexTangents,Y.toneMapping=N.toneMapping}function Pf(x,N,Y,H,W){N.isScene!==!0&&(N=$t),Fe.resetTextureUnits();let ge=N.fog,Ee=H.isMeshStandardMaterial||H.isMeshLambertMaterial||H.isMeshPhongMaterial?N.environment:null,me=he===null?F.outputColorSpace:he.isXRRenderTarget===!0?he.texture.colorSpace:Ke.workingColorSpace,be=H.isMeshStandardMaterial||H.isMeshLambertMaterial&&!H.envMap||H.isMeshPhongMaterial&&!H.envMap,Ce=A.get(H.envMap||Ee,be),Ve=H.vertexColors===!0&&!!Y.attributes.color&&Y.attributes.color.itemSize===4,$e=!!Y.attributes.tangent&&(!!H.normalMap||H.anisotropy>0),Ae=!!Y.morphAttributes.position,Ze=!!Y.morphAttributes.normal,Mt=!!Y.morphAttributes.color,ht=Un;H.toneMapped&&(he===null||he.isXRRenderTarget===!0)&&(ht=F.toneMapping);let rt=Y.morphAttributes.position||Y.morphAttributes.normal||Y.morphAttributes.color,Ut=rt!==void 0?rt.length:0,Te=Le.get(H),Ht=R.state.lights;if(vt===!0&&(Lt===!0||x!==oe)){let yt=x===oe&&H.id===K;ee.setState(H,x,yt)}let Qe=!1,Si=!1;H.version===Te.__version?Te.needsLights&&Te.lightsStateVersion!==Ht.state.version||W.isBatchedMesh&&Te.batching===!1||!W.isBatchedMesh&&Te.batching===!0||W.isBatchedMesh&&Te.batchingColor===!0&&W._colorsTexture===null||W.isBatchedMesh&&Te.batchingColor===!1&&W._colorsTexture!==null||W.isInstancedMesh&&Te.instancing===!1||!W.isInstancedMesh&&Te.instancing===!0||W.isSkinnedMesh&&Te.skinning===!1||!W.isSkinnedMesh&&Te.skinning===!0||W.isInstancedMesh&&Te.instancingColor===!0&&W.instanceColor===null||W.isInstancedMesh&&Te.instancingColor===!1&&W.instanceColor!==null||W.isInstancedMesh&&Te.instancingMorph===!0&&W.morphTexture===null||W.isInstancedMesh&&Te.instancingMorph===!1&&W.morphTexture!==null||Te.envMap!==Ce||H.fog===!0&&Te.fog!==ge||Te.numClippingPlanes!==void 0&&(Te.numClippingPlanes!==ee.numPlanes||Te.numIntersection!==ee.numIntersection)||Te.vertexAlphas!==Ve||Te.vertexTangents!==$e||Te.morphTargets!==Ae||Te.morphNormals!==Ze||Te.morphColors!==Mt||Te.morphTargetsCount!==Ut||Te.numLightProbeGrids!==Kc(R.state.lightProbeGridArray)?Qe=!0:(Te.outputColorSpace!==me||Te.toneMapping!==ht)&&(Si=!0):(Qe=!0,Te.__version=H.version);let Ft=Te.currentProgram;(Qe===!0||Si===!0)&&(Ft=Si===!0?Cf(H,N,W,me,ht):ks(H,N,W),$&&H.isNodeMaterial&&$.onUpdateProgram(H,Ft,Te));let Ur=!1,si=!1,wi=!1,Je=Ft.getUniforms(),Dt=Te.uniforms;if(ye.useProgram(Ft.program)&&(Ur=!0,si=!0,wi=!0),H.id!==K&&(K=H.id,si=!0),Ur||oe!==x){ye.buffers.depth.getReversed()&&x.reversedDepth!==!0&&(x._reversedDepth=!0,x.updateProjectionMatrix()),Je.setValue(O,"projectionMatrix",x.projectionMatrix),Je.setValue(O,"viewMatrix",x.matrixWorldInverse);let Ct=Je.map.cameraPosition;Ct!==void 0&&Ct.setValue(O,un.setFromMatrixPosition(x.matrixWorld)),lt.logarithmicDepthBuffer&&Je.setValue(O,"logDepthBufFC",2/(Math.log(x.far+1)/Math.LN2)),(H.isMeshPhongMaterial||H.isMeshToonMaterial||H.isMeshLambertMaterial||H.isMeshBasicMaterial||H.isMeshStandardMaterial||H.isShaderMaterial)&&Je.setValue(O,"isOrthographic",x.isOrthographicCamera===!0),oe!==x&&(oe=x,si=!0,wi=!0)}if(Te.needsLights&&(Ht.state.sunShadowMap.length>0&&Je.setValue(O,"sunShadowMap",Ht.state.sunShadowMap,Fe),Ht.state.directionalShadowMap.length>0&&Je.setValue(O,"directionalShadowMap",Ht.state.directionalShadowMap,Fe),Ht.state.spotShadowMap.length>0&&Je.setValue(O,"spotShadowMap",Ht.state.spotShadowMap,Fe),Ht.state.pointShadowMap.length>0&&Je.setValue(O,"pointShadowMap",Ht.state.pointShadowMap,Fe)),W.isSkinnedMesh){Je.setOptional(O,W,"bindMatrix"),Je.setOptional(O,W,"bindMatrixInverse");let yt=W.skeleton;yt&&(yt.boneTexture===null&&yt.computeBoneTexture(),Je.setValue(O,"boneTexture",yt.boneTexture,Fe))}W.isBatchedMesh&&(Je.setOptional(O,W,"batchingTexture"),Je.setValue(O,"batchingTexture",W._matricesTexture,Fe),Je.setOptional(O,W,"batchingIdTexture"),Je.setValue(O,"batchingIdTexture",W._indirectTexture,Fe),Je.setOptional(O,W,"batchingColorTexture"),W._colorsTexture!==null&&Je.setValue(O,"batchingColorTexture",W._colorsTexture,Fe));let gn=Y.morphAttributes;if((gn.position!==void 0||gn.normal!==void 0||gn.color!==void 0)&&ie.update(W,Y,Ft),(si||Te.receiveShadow!==W.receiveShadow)&&(Te.receiveShadow=W.receiveShadow,Je.setValue(O,"receiveShadow",W.receiveShadow)),(H.isMeshStandardMaterial||H.isMeshLambertMaterial||H.isMeshPhongMaterial)&&H.envMap===null&&N.environment!==null&&(Dt.envMapIntensity.value=N.environmentIntensity),Dt.dfgLUT!==void 0&&(Dt.dfgLUT.value=Lv()),si){if(Je.setValue(O,"toneMappingExposure",F.toneMappingExposure),Te.needsLights&&If(Dt,wi),ge&&H.fog===!0&&de.refreshFogUniforms(Dt,ge),de.refreshMaterialUniforms(Dt,H,_e,Pe,R.state.transmissionRenderTarget[x.id]),Te.needsLights&&Te.numLightProbeGrids>0){let yt=w,Ct=0;for(let zn of R.state.lightProbeGridArray)zn.texture!==null&&(yt.textures[Ct]=zn.texture,yt.min[Ct]=zn.boundingBox.min,yt.max[Ct]=zn.boundingBox.max,yt.resolution[Ct]=zn.resolution,Ct++);for(let zn in yt)yt[zn].length=Ct;Dt.probesSH.value=yt.textures,Dt.probesMin.value=yt.min,Dt.probesMax.value=yt.max,Dt.probesResolution.value=yt.resolution}Ds.upload(O,Jc(Te),Dt,Fe)}if(H.isShaderMaterial&&H.uniformsNeedUpdate===!0&&(Ds.upload(O,Jc(Te),Dt,Fe),H.uniformsNeedUpdate=!1),H.isSpriteMaterial&&Je.setValue(O,"center",W.center),Je.setValue(O,"modelViewMatrix",W.modelViewMatrix),Je.setValue(O,"normalMatrix",W.normalMatrix),Je.setValue(O,"modelMatrix",W.matrixWorld),H.uniformsGroups!==void 0){let yt=H.uniformsGroups;for(let Ct=0,zn=yt.length;Ct<zn;Ct++){let eh=yt[Ct];D.update(eh,Ft),D.bind(eh,Ft)}}return Ft}function If(x,N){x.ambientLightColor.needsUpdate=N,x.lightProbe.needsUpdate=N,x.sunLights.needsUpdate=N,x.sunLightShadows.needsUpdate=N,x.directionalLights.needsUpdate=N,x.directionalLightShadows.needsUpdate=N,x.pointLights.needsUpdate=N,x.pointLightShadows.needsUpdate=N,x.spotLights.needsUpdate=N,x.spotLightShadows.needsUpdate=N,x.rectAreaLights.needsUpdate=N,x.hemisphereLights.needsUpdate=N}function Lf(x){return x.isMeshLambertMaterial||x.isMeshToonMaterial||x.isMeshPhongMaterial||x.isMeshStandardMaterial||x.isShadowMaterial||x.isShaderMaterial&&x.lights===!0}this.getActiveCubeFace=function(){return se},this.getActiveMipmapLevel=function(){return Z},this.getRenderTarget=function(){return he},this.setRenderTargetTextures=function(x,N,Y){let H=Le.get(x);H.__autoAllocateDepthBuffer=x.resolveDepthBuffer===!1,H.__autoAllocateDepthBuffer===!1&&(H.__useRenderToTexture=!1),Le.get(x.texture).__webglTexture=N,Le.get(x.depthTexture).__webglTexture=H.__autoAllocateDepthBuffer?void 0:Y,H.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(x,N){let Y=Le.get(x);Y.__webglFramebuffer=N,Y.__useDefaultFramebuffer=N===void 0},this.setRenderTarget=function(x,N=0,Y=0){he=x,se=N,Z=Y;let H=null,W=!1,ge=!1;if(x){let me=Le.get(x);if(me.__useDefaultFramebuffer!==void 0){ye.bindFramebuffer(O.FRAMEBUFFER,me.__webglFramebuffer),le.copy(x.viewport),Re.copy(x.scissor),ke=x.scissorTest,ye.viewport(le),ye.scissor(Re),ye.setScissorTest(ke),K=-1;return}else if(me.__webglFramebuffer===void 0)Fe.setupRenderTarget(x);else if(me.__hasExternalTextures)Fe.rebindTextures(x,Le.get(x.texture).__webglTexture,Le.get(x.depthTexture).__webglTexture);else if(x.depthBuffer){let Ve=x.depthTexture;if(me.__boundDepthTexture!==Ve){if(Ve!==null&&Le.has(Ve)&&(x.width!==Ve.image.width||x.height!==Ve.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Fe.setupDepthRenderbuffer(x)}}let be=x.texture;(be.isData3DTexture||be.isDataArrayTexture||be.isCompressedArrayTexture)&&(ge=!0);let Ce=Le.get(x).__webglFramebuffer;x.isWebGLCubeRenderTarget?(Array.isArray(Ce[N])?H=Ce[N][Y]:H=Ce[N],W=!0):x.samples>0&&Fe.useMultisampledRTT(x)===!1?H=Le.get(x).__webglMultisampledFramebuffer:Array.isArray(Ce)?H=Ce[Y]:H=Ce,le.copy(x.viewport),Re.copy(x.scissor),ke=x.scissorTest}else le.copy(De).multiplyScalar(_e).floor(),Re.copy(je).multiplyScalar(_e).floor(),ke=nt;if(Y!==0&&(H=Q),ye.bindFramebuffer(O.FRAMEBUFFER,H)&&ye.drawBuffers(x,H),ye.viewport(le),ye.scissor(Re),ye.setScissorTest(ke),W){let me=Le.get(x.texture);O.framebufferTexture2D(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_CUBE_MAP_POSITIVE_X+N,me.__webglTexture,Y)}else if(ge){let me=N;for(let be=0;be<x.textures.length;be++){let Ce=Le.get(x.textures[be]);O.framebufferTextureLayer(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0+be,Ce.__webglTexture,Y,me)}}else if(x!==null&&Y!==0){let me=Le.get(x.texture);O.framebufferTexture2D(O.FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,me.__webglTexture,Y)}K=-1};function Qc(x){let N=Le.get(x);return(N.__readFormat!==x.format||N.__readType!==x.type)&&(N.__readFormat=x.format,N.__readType=x.type,N.__formatReadable=lt.textureFormatReadable(x.format),N.__typeReadable=lt.textureTypeReadable(x.type)),N}this.readRenderTargetPixels=function(x,N,Y,H,W,ge,Ee,me=0){if(!(x&&x.isWebGLRenderTarget)){Oe("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let be=Le.get(x).__webglFramebuffer;if(x.isWebGLCubeRenderTarget&&Ee!==void 0&&(be=be[Ee],Array.isArray(be)&&(be=be[0])),be){ye.bindFramebuffer(O.FRAMEBUFFER,be);try{let Ce=x.textures[me],Ve=Ce.format,$e=Ce.type;x.textures.length>1&&O.readBuffer(O.COLOR_ATTACHMENT0+me);let Ae=Qc(Ce);if(Ae.__formatReadable===!1){Oe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(Ae.__typeReadable===!1){Oe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}N>=0&&N<=x.width-H&&Y>=0&&Y<=x.height-W&&O.readPixels(N,Y,H,W,E.convert(Ve),E.convert($e),ge)}finally{let Ce=he!==null?Le.get(he).__webglFramebuffer:null;ye.bindFramebuffer(O.FRAMEBUFFER,Ce)}}},this.readRenderTargetPixelsAsync=async function(x,N,Y,H,W,ge,Ee,me=0){if(!(x&&x.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let be=Le.get(x).__webglFramebuffer;if(x.isWebGLCubeRenderTarget&&Ee!==void 0&&(be=be[Ee],Array.isArray(be)&&(be=be[0])),be)if(N>=0&&N<=x.width-H&&Y>=0&&Y<=x.height-W){ye.bindFramebuffer(O.FRAMEBUFFER,be);let Ce=x.textures[me],Ve=Ce.format,$e=Ce.type;x.textures.length>1&&O.readBuffer(O.COLOR_ATTACHMENT0+me);let Ae=Qc(Ce);if(Ae.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(Ae.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let Ze=O.createBuffer();O.bindBuffer(O.PIXEL_PACK_BUFFER,Ze),O.bufferData(O.PIXEL_PACK_BUFFER,ge.byteLength,O.STREAM_READ),O.readPixels(N,Y,H,W,E.convert(Ve),E.convert($e),0),O.bindBuffer(O.PIXEL_PACK_BUFFER,null);let Mt=he!==null?Le.get(he).__webglFramebuffer:null;ye.bindFramebuffer(O.FRAMEBUFFER,Mt);let ht=O.fenceSync(O.SYNC_GPU_COMMANDS_COMPLETE,0);return O.flush(),await _d(O,ht,4),O.bindBuffer(O.PIXEL_PACK_BUFFER,Ze),O.getBufferSubData(O.PIXEL_PACK_BUFFER,0,ge),O.bindBuffer(O.PIXEL_PACK_BUFFER,null),O.deleteBuffer(Ze),O.deleteSync(ht),ge}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(x,N=null,Y=0){let H=Math.pow(2,-Y),W=Math.floor(x.image.width*H),ge=Math.floor(x.image.height*H),Ee=N!==null?N.x:0,me=N!==null?N.y:0;Fe.setTexture2D(x,0),O.copyTexSubImage2D(O.TEXTURE_2D,Y,0,0,Ee,me,W,ge),ye.unbindTexture()},this.copyTextureToTexture=function(x,N,Y=null,H=null,W=0,ge=0){let Ee,me,be,Ce,Ve,$e,Ae,Ze,Mt,ht=x.isCompressedTexture?x.mipmaps[ge]:x.image;if(Y!==null)Ee=Y.max.x-Y.min.x,me=Y.max.y-Y.min.y,be=Y.isBox3?Y.max.z-Y.min.z:1,Ce=Y.min.x,Ve=Y.min.y,$e=Y.isBox3?Y.min.z:0;else{let Je=Math.pow(2,-W);Ee=Math.floor(ht.width*Je),me=Math.floor(ht.height*Je),x.isDataArrayTexture?be=ht.depth:x.isData3DTexture?be=Math.floor(ht.depth*Je):be=1,Ce=0,Ve=0,$e=0}H!==null?(Ae=H.x,Ze=H.y,Mt=H.z):(Ae=0,Ze=0,Mt=0);let rt=E.convert(N.format),Ut=E.convert(N.type),Te;N.isData3DTexture?(Fe.setTexture3D(N,0),Te=O.TEXTURE_3D):N.isDataArrayTexture||N.isCompressedArrayTexture?(Fe.setTexture2DArray(N,0),Te=O.TEXTURE_2D_ARRAY):(Fe.setTexture2D(N,0),Te=O.TEXTURE_2D),ye.activeTexture(O.TEXTURE0),ye.pixelStorei(O.UNPACK_FLIP_Y_WEBGL,N.flipY),ye.pixelStorei(O.UNPACK_PREMULTIPLY_ALPHA_WEBGL,N.premultiplyAlpha),ye.pixelStorei(O.UNPACK_ALIGNMENT,N.unpackAlignment);let Ht=ye.getParameter(O.UNPACK_ROW_LENGTH),Qe=ye.getParameter(O.UNPACK_IMAGE_HEIGHT),Si=ye.getParameter(O.UNPACK_SKIP_PIXELS),Ft=ye.getParameter(O.UNPACK_SKIP_ROWS),Ur=ye.getParameter(O.UNPACK_SKIP_IMAGES);ye.pixelStorei(O.UNPACK_ROW_LENGTH,ht.width),ye.pixelStorei(O.UNPACK_IMAGE_HEIGHT,ht.height),ye.pixelStorei(O.UNPACK_SKIP_PIXELS,Ce),ye.pixelStorei(O.UNPACK_SKIP_ROWS,Ve),ye.pixelStorei(O.UNPACK_SKIP_IMAGES,$e);let si=x.isDataArrayTexture||x.isData3DTexture,wi=N.isDataArrayTexture||N.isData3DTexture;if(x.isDepthTexture){let Je=Le.get(x),Dt=Le.get(N),gn=Le.get(Je.__renderTarget),yt=Le.get(Dt.__renderTarget);ye.bindFramebuffer(O.READ_FRAMEBUFFER,gn.__webglFramebuffer),ye.bindFramebuffer(O.DRAW_FRAMEBUFFER,yt.__webglFramebuffer);for(let Ct=0;Ct<be;Ct++)si&&(O.framebufferTextureLayer(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Le.get(x).__webglTexture,W,$e+Ct),O.framebufferTextureLayer(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Le.get(N).__webglTexture,ge,Mt+Ct)),O.blitFramebuffer(Ce,Ve,Ce+Ee,Ve+me,Ae,Ze,Ae+Ee,Ze+me,O.DEPTH_BUFFER_BIT,O.NEAREST);ye.bindFramebuffer(O.READ_FRAMEBUFFER,null),ye.bindFramebuffer(O.DRAW_FRAMEBUFFER,null)}else if(W!==0||x.isRenderTargetTexture||Le.has(x)){let Je=Le.get(x),Dt=Le.get(N);ye.bindFramebuffer(O.READ_FRAMEBUFFER,U),ye.bindFramebuffer(O.DRAW_FRAMEBUFFER,J);for(let gn=0;gn<be;gn++)si?O.framebufferTextureLayer(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Je.__webglTexture,W,$e+gn):O.framebufferTexture2D(O.READ_FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,Je.__webglTexture,W),wi?O.framebufferTextureLayer(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,Dt.__webglTexture,ge,Mt+gn):O.framebufferTexture2D(O.DRAW_FRAMEBUFFER,O.COLOR_ATTACHMENT0,O.TEXTURE_2D,Dt.__webglTexture,ge),W!==0?O.blitFramebuffer(Ce,Ve,Ce+Ee,Ve+me,Ae,Ze,Ae+Ee,Ze+me,O.COLOR_BUFFER_BIT,O.NEAREST):wi?O.copyTexSubImage3D(Te,ge,Ae,Ze,Mt+gn,Ce,Ve,Ee,me):O.copyTexSubImage2D(Te,ge,Ae,Ze,Ce,Ve,Ee,me);ye.bindFramebuffer(O.READ_FRAMEBUFFER,null),ye.bindFramebuffer(O.DRAW_FRAMEBUFFER,null)}else wi?x.isDataTexture||x.isData3DTexture?O.texSubImage3D(Te,ge,Ae,Ze,Mt,Ee,me,be,rt,Ut,ht.data):N.isCompressedArrayTexture?O.compressedTexSubImage3D(Te,ge,Ae,Ze,Mt,Ee,me,be,rt,ht.data):O.texSubImage3D(Te,ge,Ae,Ze,Mt,Ee,me,be,rt,Ut,ht):x.isDataTexture?O.texSubImage2D(O.TEXTURE_2D,ge,Ae,Ze,Ee,me,rt,Ut,ht.data):x.isCompressedTexture?O.compressedTexSubImage2D(O.TEXTURE_2D,ge,Ae,Ze,ht.width,ht.height,rt,ht.data):O.texSubImage2D(O.TEXTURE_2D,ge,Ae,Ze,Ee,me,rt,Ut,ht);ye.pixelStorei(O.UNPACK_ROW_LENGTH,Ht),ye.pixelStorei(O.UNPACK_IMAGE_HEIGHT,Qe),ye.pixelStorei(O.UNPACK_SKIP_PIXELS,Si),ye.pixelStorei(O.UNPACK_SKIP_ROWS,Ft),ye.pixelStorei(O.UNPACK_SKIP_IMAGES,Ur),ge===0&&N.generateMipmaps===!0&&N.mipmapsAutoUpdate===!0&&O.generateMipmap(Te),ye.unbindTexture()},this.initRenderTarget=function(x){Le.get(x).__webglFramebuffer===void 0&&Fe.setupRenderTarget(x)},this.initTexture=function(x){x.isCubeTexture?Fe.setTextureCube(x,0):x.isData3DTexture?Fe.setTexture3D(x,0):x.isDataArrayTexture||x.isCompressedArrayTexture?Fe.setTexture2DArray(x,0):Fe.setTexture2D(x,0),ye.unbindTexture()},this.resetState=function(){se=0,Z=0,he=null,ye.reset(),C.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return pn}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=Ke._getDrawingBufferColorSpace(e),t.unpackColorSpace=Ke._getUnpackColorSpace()}};Hr();var Wi=class extends In{constructor(t={}){super();this.progress=t;this.metadata=new Map;this.origin=new Int32Array(0);this.refined=new Uint8Array(0);this.refinedVertices=0;this.blocks=0;this.carried=[];this.points=new Float32Array(0);this.pieces=[];this.frames=[];this.shown=-1;this.normals=new Float32Array(0);this.drawn=0}get frameRate(){let t=this.metadata.get("frame_rate");return typeof t=="number"&&t>0&&t<1/0?t:0}accept(t){switch(t.type){case"header":this.header=t.header;return;case"metadata":return t.entries.forEach((n,s)=>this.metadata.set(s,n)),this.progress.onMetadata?.(t.entries,this);case"begun":return this.begin(t);case"grown":return this.grow(t);case"whole":return this.coming=t.shape,t.run===0?this.take(t.shape):void 0;case"attribute":return void this.carried.push(t);case"frame":return this.keep(t);case"loss":return this.lose(t)}}showFrame(t){let{positions:n,normals:s,attributes:r,shape:a}=this.frames[t];if(t===this.shown)return;this.shown=t,a!==this.worn&&this.take(a);let o=this.getAttribute("position");o.array=n,o.needsUpdate=!0;let l=this.getAttribute("normal");l.array instanceof Int16Array||this.setAttribute("normal",l=new bt(s,3,!0)),l.array=s,l.needsUpdate=!0;for(let{name:c,values:h}of r){let d=this.getAttribute(c);d.array=h,d.needsUpdate=!0}}begin({vertices:t,corners:n,loose:s}){this.refuseIfWhole(),this.points=new Float32Array(3*t),this.normals=new Float32Array(3*t),this.origin=new Int32Array(t).fill(-1),this.refined=new Uint8Array(t),s.vertices.forEach((r,a)=>this.points.set(s.positions.subarray(3*a,3*a+3),3*r)),this.setAttribute("position",new bt(this.points,3)),this.setAttribute("normal",new bt(this.normals,3)),this.setIndex(new bt(new Uint32Array(n),1)),this.setDrawRange(0,this.drawn),this.progress.onConnectivity?.(this)}grow({vertices:t,positions:n,normals:s,origin:r,refined:a,index:o,blocks:l}){this.refuseIfWhole();let{points:c,normals:h}=this;for(let u=0;u<t.length;u++){let[f,_]=[3*t[u],3*u];[c[f],c[f+1],c[f+2]]=[n[_],n[_+1],n[_+2]],[h[f],h[f+1],h[f+2]]=[s[_],s[_+1],s[_+2]],this.origin[t[u]]=r[u],this.refinedVertices+=a[u]-this.refined[t[u]],this.refined[t[u]]=a[u]}let d=this.getIndex();d?.array.set(o,this.drawn),this.drawn+=o.length;for(let u of[d,this.getAttribute("position"),this.getAttribute("normal")])u&&(u.needsUpdate=!0);this.setDrawRange(0,this.drawn),[this.boundingBox,this.boundingSphere]=[null,null],this.blocks=l,this.progress.onBlock?.(this)}refuseIfWhole(){if(this.worn)throw new Error("this geometry is whole and cannot grow")}take(t){let{index:n,positions:s,normals:r,attributes:a,vertices:o,pieces:l,center:c,radius:h,low:d,high:u}=t;if(this.getIndex()&&this.dispose(),this.worn)for(let{name:f}of this.worn.attributes)this.deleteAttribute(f);this.worn=t,this.clearGroups(),this.parted=o,this.pieces=l,this.setIndex(new bt(n,1)),this.setAttribute("position",new bt(s,3)),this.setAttribute("normal",new bt(r,3));for(let{name:f,values:_,components:M}of a)this.setAttribute(f,new bt(_,M));this.colour=this.attributes.color,this.setDrawRange(0,n.length),l.some(({material:f})=>f>0)&&l.forEach(({start:f,count:_,material:M})=>this.addGroup(f,_,M)),this.boundingBox=new Pn(new z(...d),new z(...u)),this.boundingSphere=new pi(new z(...c),h)}keep({index:t,positions:n,normals:s,attributes:r}){this.frames.push({positions:n,normals:s,attributes:r,shape:Nt(this.coming)}),t===0&&this.showFrame(0),this.progress.onFrame?.(t,this)}lose({frames:t}){let n=this.frames.at(-1);for(let s=0;n&&s<(t?.count??0);s++)this.frames.push(n)}};function Gc(i){let e=i.get("up");return e==="z"?[-Math.PI/2,0,0]:e==="x"?[0,0,Math.PI/2]:[0,0,0]}var Dv={baseColorTexture:["map"],map_Kd:["map"],emissiveTexture:["emissiveMap"],map_Ke:["emissiveMap"],normalTexture:["normalMap"],norm:["normalMap"],metallicRoughnessTexture:["metalnessMap","roughnessMap"],occlusionTexture:["aoMap"]},Nv=["map","emissiveMap"];async function rf(i){let e=[...i].flatMap(([n,s])=>{let r=/^image\.(\d+)\.data$/.exec(n);return r&&s instanceof Uint8Array?[[Number(r[1]),s]]:[]}),t=await Promise.all(e.map(async([n,s])=>[n,await Uv(s)]));return new Map(t.flatMap(([n,s])=>s?[[n,s]]:[]))}async function Uv(i){try{let e=await createImageBitmap(new Blob([i]),{imageOrientation:"flipY",colorSpaceConversion:"none"}),t=new zt(e);return t.flipY=!1,t.wrapS=t.wrapT=_s,t.needsUpdate=!0,t}catch{return}}function af(i,e,t){let n=Array.from({length:t},()=>new Map);for(let[s,r]of i){let a=/^material\.(\d+)\.(.+)$/s.exec(s);a&&Number(a[1])<t&&(typeof r=="string"||typeof r=="number")&&n[Number(a[1])].set(a[2],r)}return n.map(s=>Fv(s,e))}function sf(i){return String(i??"").split(/\s+/).filter(Boolean).map(Number)}function Fv(i,e){let t=!["baseColorFactor","baseColorTexture","metallicFactor","roughnessFactor"].some(d=>i.has(d)),n=new Bi({name:String(i.get("name")??""),metalness:t?0:1,roughness:1}),[s=1,r=1,a=1,o=1]=sf(i.get("baseColorFactor")??i.get("Kd"));i.has("baseColorFactor")?n.color.setRGB(s,r,a):n.color=new Ge().setRGB(s,r,a,kt);let l=sf(i.get("emissiveFactor")??i.get("Ke"));l.length===3&&n.emissive.setRGB(l[0],l[1],l[2]);for(let[d,u]of[["metallicFactor","metalness"],["Pm","metalness"],["roughnessFactor","roughness"],["Pr","roughness"]])i.has(d)&&(n[u]=Number(i.get(d)));for(let[d,u]of Object.entries(Dv)){let f=e.get(Number(i.get(d)??NaN));if(f)for(let _ of u)n[_]=Ov(f,Nv.includes(_))}n.emissiveMap&&l.length===0&&n.emissive.set(16777215);let c=o*Number(i.get("d")??1),h=i.get("alphaMode");return n.opacity=c,n.transparent=h==="BLEND"||h===void 0&&c<1,h==="MASK"&&(n.alphaTest=Number(i.get("alphaCutoff")??.5)),n.side=t||Number(i.get("doubleSided")??0)?Qt:Nn,n}function Ov(i,e){let t=e?kt:En;return i.colorSpace===t||(i.userData.taken&&(i=i.clone(),i.needsUpdate=!0),i.userData.taken=!0,i.colorSpace=t),i}xt();var Hc={plain:"",own:"",blocks:"Order in which blocks arrive",refined:"Vertices that refinement has moved",error:"Distance from the original"},Cr=["#e9eef2","#ffe08a","#fd9a3c","#e0312d","#7a0f6b"],of=`linear-gradient(90deg, ${Cr.join(", ")})`,Bv=Array.from({length:256},(i,e)=>{let t=e/255*(Cr.length-1),n=Math.min(Math.floor(t),Cr.length-2);return new Ge(Cr[n]).lerp(new Ge(Cr[n+1]),t-n).toArray()});function lf(i,e){let t=Float64Array.from(i).filter(r=>r>=0).sort(),n=t[Math.floor(.995*(t.length-1))]/e||1e-9,s=10**Math.floor(Math.log10(n));return s*[1,2,5,10].find(r=>r*s>=n)}function cf(i,e,t,n=1){let{header:s,origin:r,refined:a,parted:o}=i;if(e==="plain"||e==="own"||!s)return;let l=Math.max((s.blocks||i.blocks)-1,1),c={blocks:f=>r[f]/l,refined:f=>a[f],error:f=>t[f]/n},h=i.getAttribute("position").count,d=e==="error"?t?.length??0:r.length;if(d===0||(o??{length:d}).length!==h)return;let u=new Float32Array(3*h);for(let f=0;f<h;f++)u.set(Bv[Math.round(255*Math.min(Math.max(c[e](o?o[f]:f)||0,0),1))],3*f);return u}function ni(i){return i.toLocaleString("en")}function Jo(i){return i<1e3?`${Math.ceil(i)} ms`:`${(i/1e3).toFixed(2)} s`}function kn(i){let[e,t]=i<1e3?[i,"bytes"]:i<1e7?[i/1e3,"kB"]:[i/1e6,"MB"];return`${e.toLocaleString("en",{maximumFractionDigits:e<100&&t!=="bytes"?1:0})} ${t}`}function Pr(i){return`${Number((100*i).toPrecision(2))} %`}function hf(i){return i.toLocaleString("en",{maximumFractionDigits:i<10?1:0})}function ii(i,e,...t){let n=document.createElement(i);return n.textContent=e,n.append(...t),n}function uf({layers:i,main:e,facts:t},n,s,r,a){let o=i[e].size||n,[l,c]=[r?.vertices??0,r?.faces??0],h=e>0?i[0].size:12*(l*Math.max(s,1)+c),d=h/Math.max(o,1),u=e>0?"":s>1?" than its frames as float32":" than plain arrays",{look:f,farthest:_,theta:M,seconds:p,promised:g={},draco:S}=t,P=f===void 0?"":g.look?`look ${f.toFixed(2)} of ${g.look}`:`look ${f.toFixed(2)}`,w=[];return f!==void 0&&w.push(["Look",P.slice(5),g.look?"promised; up to 1 it looks alike":"up to 1 it looks alike"]),_!==void 0&&w.push(["Farthest vertex",Pr(_),`of the diagonal${g.farthest?`; promised ${Pr(g.farthest)}`:""}`]),M!==void 0&&w.push(["Normals",`${M.toFixed(1)}°`,"off on average"]),S&&w.push(["Draco at this look",kn(S.bytes),`${S.bits} bits, ${hf(S.bytes/o)} times as much`]),p!==void 0&&w.push(["Encoded in",Jo(1e3*p)]),a!==void 0&&w.push(["Decoded here in",Jo(a)]),l>0&&w.push(["Mesh",`${ni(l)} vertices`,`${ni(c)} triangles`]),s>1&&w.push(["Sequence",`${ni(s)} frames`,`${kn(Math.round(o/s))} a frame`]),{plain:h,size:o,claim:[o>0&&d>1?`${hf(d)} times smaller${u}`:"",P].filter(Boolean).join(", "),rows:w}}var jo=class{constructor(e,t){this.given=e;this.loop=!0;this.at=.1;this.before=0;this.waiting=!0;this.playing=t}get rate(){return this.given>0?this.given:24}get frame(){return Math.floor(this.at)}seek(e){this.at=e+.1}step(e,t,n){let s=Math.max(0,e-this.before)/1e3*this.rate;this.before=e,t!==0&&(this.waiting?this.waiting=!n&&t-this.at<.5*this.rate:this.playing&&(this.at+=s),!(this.at<t)&&(n&&this.playing&&this.loop?this.at=.1:(this.at=t-1,this.playing&&=!n,this.waiting=!n)))}};var df={type:"change"},Xc={type:"start"},pf={type:"end"},Qo=new Ss,ff=new an,kv=Math.cos(70*Fn.DEG2RAD),Rt=new z,tn=2*Math.PI,tt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Wc=1e-6,el=class extends mr{constructor(e,t=null){super(e,t),this.state=tt.NONE,this.target=new z,this.cursor=new z,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:xi.ROTATE,MIDDLE:xi.DOLLY,RIGHT:xi.PAN},this.touches={ONE:bi.ROTATE,TWO:bi.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new z,this._lastQuaternion=new on,this._lastTargetPosition=new z,this._quat=new on().setFromUnitVectors(e.up,new z(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Dn,this._sphericalDelta=new Dn,this._scale=1,this._panOffset=new z,this._rotateStart=new Be,this._rotateEnd=new Be,this._rotateDelta=new Be,this._panStart=new Be,this._panEnd=new Be,this._panDelta=new Be,this._dollyStart=new Be,this._dollyEnd=new Be,this._dollyDelta=new Be,this._dollyDirection=new z,this._mouse=new Be,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=Vv.bind(this),this._onPointerDown=zv.bind(this),this._onPointerUp=Gv.bind(this),this._onContextMenu=Zv.bind(this),this._onMouseWheel=Xv.bind(this),this._onKeyDown=qv.bind(this),this._onTouchStart=Yv.bind(this),this._onTouchMove=$v.bind(this),this._onMouseDown=Hv.bind(this),this._onMouseMove=Wv.bind(this),this._interceptControlDown=Kv.bind(this),this._interceptControlUp=Jv.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=tt.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(df),this.update(),this.state=tt.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;Rt.copy(t).sub(this.target),Rt.applyQuaternion(this._quat),this._spherical.setFromVector3(Rt),this.autoRotate&&this.state===tt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=tn:n>Math.PI&&(n-=tn),s<-Math.PI?s+=tn:s>Math.PI&&(s-=tn),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let a=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=a!=this._spherical.radius}if(Rt.setFromSpherical(this._spherical),Rt.applyQuaternion(this._quatInverse),t.copy(this.target).add(Rt),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let a=null;if(this.object.isPerspectiveCamera){let o=Rt.length();a=this._clampDistance(o*this._scale);let l=o-a;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let o=new z(this._mouse.x,this._mouse.y,0);o.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new z(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(o),this.object.updateMatrixWorld(),a=Rt.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;a!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(a).add(this.object.position):(Qo.origin.copy(this.object.position),Qo.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(Qo.direction))<kv?this.object.lookAt(this.target):(ff.setFromNormalAndCoplanarPoint(this.object.up,this.target),Qo.intersectPlane(ff,this.target))))}else if(this.object.isOrthographicCamera){let a=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),a!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>Wc||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Wc||this._lastTargetPosition.distanceToSquared(this.target)>Wc?(this.dispatchEvent(df),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?tn/60*this.autoRotateSpeed*e:tn/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Rt.setFromMatrixColumn(t,0),Rt.multiplyScalar(-e),this._panOffset.add(Rt)}_panUp(e,t){this.screenSpacePanning===!0?Rt.setFromMatrixColumn(t,1):(Rt.setFromMatrixColumn(t,0),Rt.crossVectors(this.object.up,Rt)),Rt.multiplyScalar(e),this._panOffset.add(Rt)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Rt.copy(s).sub(this.target);let r=Rt.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/n.clientHeight,this.object.matrix),this._panUp(2*t*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),s=e-n.left,r=t-n.top,a=n.width,o=n.height;this._mouse.x=s/a*2-1,this._mouse.y=-(r/o)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(tn*this._rotateDelta.x/t.clientHeight),this._rotateUp(tn*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(tn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-tn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(tn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-tn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(n,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let n=this._getSecondPointerPosition(e),s=.5*(e.pageX+n.x),r=.5*(e.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(tn*this._rotateDelta.x/t.clientHeight),this._rotateUp(tn*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let a=(e.pageX+t.x)*.5,o=(e.pageY+t.y)*.5;this._updateZoomParameters(a,o)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new Be,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function zv(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function Vv(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function Gv(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(pf),this.state=tt.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function Hv(i){let e;switch(i.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case xi.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=tt.DOLLY;break;case xi.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=tt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=tt.ROTATE}break;case xi.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=tt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=tt.PAN}break;default:this.state=tt.NONE}this.state!==tt.NONE&&this.dispatchEvent(Xc)}function Wv(i){switch(this.state){case tt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case tt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case tt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function Xv(i){this.enabled===!1||this.enableZoom===!1||this.state!==tt.NONE||(i.preventDefault(),this.dispatchEvent(Xc),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(pf))}function qv(i){this.enabled!==!1&&this._handleKeyDown(i)}function Yv(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case bi.ROTATE:if(this.enableRotate===!1){this.state=tt.NONE;break}this._handleTouchStartRotate(i),this.state=tt.TOUCH_ROTATE;break;case bi.PAN:if(this.enablePan===!1){this.state=tt.NONE;break}this._handleTouchStartPan(i),this.state=tt.TOUCH_PAN;break;default:this.state=tt.NONE}break;case 2:switch(this.touches.TWO){case bi.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=tt.TOUCH_DOLLY_PAN;break;case bi.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=tt.TOUCH_DOLLY_ROTATE;break;default:this.state=tt.NONE}break;default:this.state=tt.NONE}this.state!==tt.NONE&&this.dispatchEvent(Xc)}function $v(i){switch(this._trackPointer(i),this.state){case tt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case tt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case tt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case tt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=tt.NONE}}function Zv(i){this.enabled!==!1&&i.preventDefault()}function Kv(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function Jv(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var jv=[[-.6,.65,.5,3.5,14],[.9,.25,.35,.6,5],[.35,.5,-.8,2.5,10]],[Qv,qc,ex]=[.62,.42,.2],[Xi,Ir]=[128,64];function mf(){let i=new Uint16Array(4*Xi*Ir),[e,t,n]=[new z,new pr,new Array(9)];for(let r=0;r<Xi*Ir;r++){e.setFromSphericalCoords(1,Math.PI*(1-(Math.floor(r/Xi)+.5)/Ir),2*Math.PI*(r%Xi+.5)/Xi);let a=qc+(e.y>0?Qv-qc:qc-ex)*e.y,o=jv.reduce((c,[h,d,u,f,_])=>c+f*Math.exp(_*(e.dot(new z(h,d,u).normalize())-1)),a);[1.02,1,.97,1].forEach((c,h)=>i[4*r+h]=ir.toHalfFloat(h<3?c*o:1)),Es.getBasisAt(e,n);let l=2*Math.PI*Math.PI/Xi/Ir*Math.sqrt(1-e.y*e.y);t.sh.coefficients.forEach((c,h)=>c.addScalar(n[h]*o*l))}let s=new Fi(i,Xi,Ir);return Object.assign(s,{type:hn,mapping:Ps,magFilter:wt,minFilter:wt,needsUpdate:!0}),{texture:s,probe:t}}var nn=96,tx=.5,nx=7,ix=1e5,Fs=2;function gf(i,e,t,n=new Fi(new Uint8Array(4*nn*nn),nn,nn)){let[s,r]=[i.getAttribute("position"),i.getIndex()],a=new Float32Array(nn*nn),[o,l,c]=[new z,new z,new z],h=3*Math.ceil(i.drawRange.count/3/ix);for(let u=0;u+2<Math.min(i.drawRange.count,r.count);u+=h){[o,l,c].forEach((_,M)=>_.fromBufferAttribute(s,r.getX(u+M)).applyMatrix4(e));let f=Math.min(Math.ceil(Math.max(o.distanceTo(l),l.distanceTo(c),c.distanceTo(o))/Fs*nn),nn)||1;for(let _=0;_<=f;_++)for(let M=0;_+M<=f;M++){let[p,g]=[_/f,M/f],[S,P,w]=[o.x+p*(l.x-o.x)+g*(c.x-o.x),o.y+p*(l.y-o.y)+g*(c.y-o.y),o.z+p*(l.z-o.z)+g*(c.z-o.z)],I=nn*Math.floor((.5-w/Fs)*nn)+Math.floor((.5+S/Fs)*nn),R=tx*Math.exp(nx*(t-P));a[I]<R&&(a[I]=R)}}for(let u of[1,nn,1,nn,1,nn])a=a.map((f,_)=>(a[_-2*u]+a[_-u]+a[_]+a[_+u]+a[_+2*u])/5||0);let d=n.image.data;return a.forEach((u,f)=>d[4*f+1]=255*u),Object.assign(n,{magFilter:wt,minFilter:wt,needsUpdate:!0}),n}var tl=Math.PI/24,_f=1.1,bf=30/180*Math.PI,yf=1.06/Math.sin(bf/2),sx=.94,rx=70,Mf=13485754,vf=16777215,Yc=new Dn(1,72*Fn.DEG2RAD,35*Fn.DEG2RAD),ax=.35,xf=44,[ox,lx]=[400,2],cx=5e3,hx=30,Lr=class{constructor(){this.holder=new xn;this.clay=new Bi({color:Mf,roughness:.6,side:Qt});this.clothes=[]}put(e){this.clear(),this.mesh=new qt(e,this.clay),this.mesh.frustumCulled=!1,this.holder.add(this.mesh)}clear(){this.holder.clear(),this.mesh?.geometry.dispose();for(let e of this.clothes)e.dispose();[this.clothes,this.mesh]=[[],void 0]}get materials(){return[this.clay,...this.clothes]}};function ux(){let i=document.createElement("canvas").getContext("webgl2",{failIfMajorPerformanceCaveat:!0}),e=i?.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL??i?.RENDERER,t=e?String(i.getParameter(e)):"software";return i?.getExtension("WEBGL_lose_context")?.loseContext(),!/software|swiftshader|llvmpipe|basic render/i.test(t)}var nl=class{constructor(e){this.canvas=e;this.mode="one";this.sides=[0,0];this.wipe=.5;this.camera=new Wt(30,1,.01,100);this.scene=new nr;this.fast=ux();this.key=new fr(vf,1.5);this.ground=new qt(new Oi(Fs,Fs),new Ui({color:0,transparent:!0,depthWrite:!1,toneMapped:!1}));this.wires=new Ui({wireframe:!0,color:1053720,transparent:!0,opacity:.35});this.turned=new xn;this.drawn=[new Lr,new Lr,new Lr];this.tiles=new xn;this.shading="smooth";this.stale=!0;this.moved=0;this.touched=!1;this.size=[1,1];this.renderer=new $o({canvas:e,antialias:this.fast,alpha:!0}),this.renderer.setPixelRatio(devicePixelRatio),this.renderer.autoClear=!1,this.renderer.toneMapping=_r,this.controls=new el(this.camera,e),this.controls.enableDamping=!0,this.controls.autoRotateSpeed=4,this.controls.addEventListener("change",()=>this.redraw()),this.controls.addEventListener("start",()=>this.touched=!0),this.camera.position.setFromSpherical(Yc).setLength(yf/2);let{texture:t,probe:n}=mf();this.fast?this.scene.environment=new Ns(this.renderer).fromEquirectangular(t).texture:this.scene.add(n),this.light=0,this.ground.rotation.x=-Math.PI/2,this.ground.visible=!1,this.scene.add(this.key,this.ground,this.turned),this.turned.add(this.tiles,...this.drawn.map(({holder:s})=>s)),e.addEventListener("keydown",s=>this.turn(s))}show(e,t){this.drawn[e].put(t),this.shade(this.shading)}place(e,t,n=[0,0,0]){let{turned:s}=this;s.rotation.set(...n),s.scale.setScalar(1/t),s.position.set(-e[0]/t,-e[1]/t,-e[2]/t).applyEuler(s.rotation),s.updateWorldMatrix(!0,!1),this.redraw()}fill(e,t,n){let[s,r]=[new z(1/0,1/0,1/0),new z(-1/0,-1/0,-1/0)],a=new z,o=S=>{for(let P of e)for(let w=0;w<P.length;w+=3)P[w]===P[w]&&(a.set(P[w],P[w+1],P[w+2]),S())};if(o(()=>(s.min(a),r.max(a))),this.touched||!(s.x<=r.x))return;this.place(s.clone().add(r).divideScalar(2).toArray(),s.distanceTo(r)||1,t);let l=new z;for(let S=0;S<(n?.count??0);S++)l.add(a.fromBufferAttribute(n,S));l.divideScalar(n?.count||1).applyEuler(this.turned.rotation);let c=Yc.clone();Math.hypot(l.x,l.z)>ax&&(c.theta+=Math.atan2(l.x,l.z)),this.camera.position.setFromSpherical(c),this.controls.update();let[h,d]=this.size,u=this.turned.matrixWorld.clone().premultiply(new ut().makeRotationFromQuaternion(this.camera.quaternion.clone().invert())),f=sx*Math.tan(this.camera.fov/2/Fn.RAD2DEG),[_,M]=[f*(h/d),Math.max(f*(1-2*rx/d),f/2)],p=.1,g=new z;this.ground.position.y=1/0,o(()=>{this.ground.position.y=Math.min(this.ground.position.y,g.copy(a).applyMatrix4(this.turned.matrixWorld).y),a.applyMatrix4(u),p=Math.max(p,a.z+Math.abs(a.x)/_,a.z+Math.abs(a.y)/M)}),this.camera.position.setLength(p),this.redraw()}shadow(e){let{ground:t,turned:n}=this;t.position.y!==1/0&&(t.material.alphaMap=gf(e,n.matrixWorld,t.position.y,t.material.alphaMap??void 0),t.material.needsUpdate||=!t.visible,t.visible=!0,this.redraw())}clear(){for(let e of this.drawn)e.clear();this.ground.visible=!1,this.tiles.clear(),this.touched=!1,this.camera.position.setFromSpherical(Yc).setLength(yf/2),this.controls.target.set(0,0,0),this.redraw()}together(e){let{clay:t}=this.drawn[0],n=new Set(e);for(let s of[...this.tiles.children])n.delete(s.geometry)||this.tiles.remove(s);for(let s of n){let r=new qt(s,t);this.tiles.add(r),this.edge(r)}this.whiten(t,e.some(s=>s.hasAttribute("color"))),this.redraw()}get eye(){return this.turned.updateWorldMatrix(!0,!1),{place:this.turned.worldToLocal(this.camera.position.clone()),pixels:this.size[1]*devicePixelRatio/(2*Math.tan(this.camera.fov/2/Fn.RAD2DEG))}}dress(e,t){this.drawn[e].clothes=t,this.shade(this.shading)}shade(e){this.shading=e;for(let t of this.drawn){for(let n of t.materials)n.flatShading=e!=="smooth",n.polygonOffset=e==="wire",n.polygonOffsetFactor=n.polygonOffsetUnits=1,n.needsUpdate=!0;t.mesh&&this.edge(t.mesh)}for(let t of this.tiles.children)this.edge(t);this.redraw()}color(e,t,n=!1){let{mesh:s,clay:r,clothes:a}=this.drawn[e];s&&(s.material=n&&a.length>0?a.length>1?a:a[0]:r,t&&s.geometry.setAttribute("color",t),this.whiten(r,t!==void 0),this.redraw())}set light(e){let t=e*Fn.DEG2RAD;this.scene.environmentRotation.y=t,this.key.position.set(-1.2,1.9,1.5).applyAxisAngle(this.scene.up,t),this.redraw()}get spin(){return this.controls.autoRotate}set spin(e){this.controls.autoRotate=e}get seam(){return this.mode==="split"?this.size[0]/2:xf/2+this.wipe*(this.size[0]-xf)}redraw(){this.stale=!0}step(){this.controls.update();let e=performance.now();this.stale?this.renew(1,e):!this.fast&&e-this.moved>ox&&this.renderer.getPixelRatio()===devicePixelRatio&&this.renew(lx,this.moved)}picture(e,[t,n,s],r=document.createElement("canvas")){this.draw();let a=this.renderer.getPixelRatio(),{width:o,height:l}=this.canvas;[r.width,r.height]=[o,l];let c=r.getContext("2d"),h=c.createRadialGradient(o/2,.42*l,0,o/2,.42*l,.6*Math.hypot(o,l));h.addColorStop(0,n),h.addColorStop(.85,s),c.fillStyle=h,c.fillRect(0,0,o,l),c.drawImage(this.canvas,0,0);let d=(this.mode==="one"?0:this.seam)*a;return[c.fillStyle,c.textAlign]=[t,"center"],c.font=`600 ${15*a}px system-ui, sans-serif`,d>0&&c.fillRect(d-1,0,2,l),[[0,d],[d,o]].forEach(([u,f],_)=>f>u&&c.fillText(e[_],(u+f)/2,l-18*a)),r}async film(e,t,n){let s=this.picture(e,t),r=["video/mp4","video/webm"].find(d=>MediaRecorder.isTypeSupported(d)),a=new MediaRecorder(s.captureStream(hx),{mimeType:r,videoBitsPerSecond:12e6}),o=[];a.addEventListener("dataavailable",({data:d})=>o.push(d));let l=new Promise(d=>a.addEventListener("stop",d)),c=new Dn().setFromVector3(this.camera.position.clone().sub(this.controls.target)),{theta:h}=c;a.start();for(let d=performance.now(),u=0;u<1;)u=Math.min((performance.now()-d)/cx,1),c.theta=h+2*Math.PI*u,this.from(c),this.picture(e,t,s),n(u),await new Promise(requestAnimationFrame);return a.stop(),await l,new Blob(o,{type:r})}dispose(){this.controls.dispose(),this.clear(),this.renderer.dispose(),this.renderer.forceContextLoss()}renew(e,t){this.moved=t;let n=e*devicePixelRatio;this.renderer.getPixelRatio()!==n&&this.renderer.setPixelRatio(n),this.draw()}draw(){this.stale=!1;let[e,t]=this.size,{renderer:n,sides:s}=this;if(n.setScissorTest(!1),n.setViewport(0,0,e,t),n.clear(),this.mode==="one")return this.render(s[1]);let{seam:r}=this;n.setScissorTest(!0);for(let[a,o,l]of[[0,0,r],[1,r,e]])n.setScissor(o,0,l-o,t),this.mode==="split"&&n.setViewport(o,0,l-o,t),this.render(s[a])}render(e){this.drawn.forEach((t,n)=>t.holder.visible=n===e),this.renderer.render(this.scene,this.camera)}edge(e){if(e.clear(),this.shading!=="wire")return;let t=new qt(e.geometry,this.wires);t.frustumCulled=e.frustumCulled,e.add(t)}whiten(e,t){e.vertexColors!==t&&(e.vertexColors=t,e.color.set(t?vf:Mf),e.needsUpdate=!0)}fit(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement;(e!==this.size[0]||t!==this.size[1])&&this.renderer.setSize(e,t,!1),this.size=[e,t],this.camera.aspect=e/(this.mode==="split"?2:1)/Math.max(t,1),this.camera.fov=2*Fn.RAD2DEG*Math.atan(Math.tan(bf/2)/Math.min(this.camera.aspect,1)),this.camera.updateProjectionMatrix(),this.draw()}from(e){this.camera.position.setFromSpherical(e.makeSafe()).add(this.controls.target),this.controls.update(),this.redraw()}turn(e){let t=new Dn().setFromVector3(this.camera.position.clone().sub(this.controls.target));if(e.key==="ArrowLeft")t.theta-=tl;else if(e.key==="ArrowRight")t.theta+=tl;else if(e.key==="ArrowUp")t.phi-=tl;else if(e.key==="ArrowDown")t.phi+=tl;else if(e.key==="+")t.radius/=_f;else if(e.key==="-")t.radius*=_f;else return;e.preventDefault(),this.touched=!0,this.from(t)}};var dx=3e6,fx=4,px=16,mx=1,$c=class{constructor(e,t,{cell:n,origin:s}){this.entry=e;this.url=t;this.below=[];this.asked=!1;this.tried=!1;let[r,a]=[e.low,e.high].map(o=>new z(...o.map((l,c)=>l*n+s[c])));this.center=r.clone().add(a).divideScalar(2),this.radius=r.distanceTo(a)/2}off(e,t){return this.below.length===0?0:t*this.entry.error/Math.max(e.distanceTo(this.center)-this.radius,.001*this.radius)}};async function Sf(i,e,t,n){let s=await fetch(i,{headers:{Range:`bytes=${e}-${e+t-1}`}});if(s.status!==206)throw new Error(`${i}: ${s.status} ${s.statusText}`);let r=new Uint8Array(await s.arrayBuffer());if(Array.from(new Uint8Array(await crypto.subtle.digest("SHA-256",r)),o=>o.toString(16).padStart(2,"0")).join("")!==n)throw new Error(`${i}: bytes from ${e} on are not what was written`);return r}function sl(i,e){return new Promise((t,n)=>{let s=new Wi,r=i.open({onPicture:a=>s.accept(a),onEnd:()=>t(s),onError:n},{drawing:"whole"});r.receiveData(e),r.receiveEof()})}var il=class i{constructor(e,t,n,s){this.manifest=e;this.tops=t;this.pool=n;this.changed=s;this.problem="";this.got=0;this.there=0;this.cut=new Set;this.wanted=[];this.loading=0;this.closed=!1}static async open(e,t,n){let s=await fetch(`${e}/manifest.json`);if(!s.ok)throw new Error(`${e}: ${s.status} ${s.statusText}`);let r=await s.json();t.preload(Object.keys(r.attributes??{}).length>0?"whole":"small").catch(()=>{});let a=new Map;for(let{file:o,size:l,index:c,sha256:h}of r.shards){let d=`${e}/${o}`,u=new TextDecoder().decode(await Sf(d,l-px-c,c,h));for(let f of JSON.parse(u))a.set(f.name,new $c(f,d,r))}for(let[o,l]of a)a.get(o.slice(0,-1))?.below.push(l);return new i(r,[...a].flatMap(([o,l])=>a.has(o.slice(0,-1))?[]:[l]),t,n)}get extent(){let e=this.tops.reduce((t,{center:n})=>t.add(n),new z).divideScalar(this.tops.length);return{center:e.toArray(),diagonal:2*Math.max(...this.tops.map(t=>t.center.distanceTo(e)+t.radius))}}look(e,t){let n=new Set(this.tops),s=this.tops.reduce((l,{entry:c})=>l+c.faces,0),r=[...this.tops];for(;;){let l=[...n].reduce((h,d)=>d.off(e,t)>h[0]?[d.off(e,t),d]:h,[mx,void 0])[1];if(!l)break;let c=l.below.reduce((h,{entry:d})=>h+d.faces,-l.entry.faces);if(s+c>dx)break;s+=c,n.delete(l),l.below.forEach(h=>n.add(h)),r.push(...l.below)}this.cut=n,this.wanted=r;let a=new Set(r),o=l=>{!a.has(l)&&l.geometry&&([l.geometry,l.asked]=[l.geometry.dispose(),!1]),l.below.forEach(o)};this.tops.forEach(o),this.load()}get shown(){let e=t=>{let n=t.geometry&&[t.geometry];if(this.cut.has(t))return n;let s=t.below.map(e);return s.every(r=>r!==void 0)?s.flat():n};return this.tops.flatMap(t=>e(t)??[])}get complete(){return this.loading===0&&this.wanted.every(({asked:e})=>e)}close(){this.closed=!0,this.tops.forEach(function e(t){t.geometry?.dispose(),t.below.forEach(e)})}load(){for(let e of this.wanted){if(this.closed||this.loading>=(this.tops.every(({tried:t})=>t)?fx:this.tops.length))return;e.asked||(e.asked=!0,this.loading++,this.fetched(e).finally(()=>{this.loading--,e.tried=!0,this.load(),this.closed||this.changed()}))}}async fetched(e){let{offset:t,size:n,sha256:s,name:r}=e.entry;try{let a=await Sf(e.url,t,n,s),o=await sl(this.pool,a);if(this.got+=a.length,this.there++,this.closed||!this.wanted.includes(e)){o.dispose(),e.asked=!1;return}o.colour&&o.setAttribute("color",o.colour),e.geometry=o}catch(a){this.problem=`Tile ${r} cannot be shown, a coarser one stands in its place: ${a instanceof Error?a.message:a}`}}};var wf=`<style>
.bsm { --ink: light-dark(#16181d, #f2f3f5); --soft: light-dark(#5b6270, #a5adba); --face: light-dark(#ffffffd9, #1b1e25d9); --line: light-dark(#0f172a1f, #ffffff24); --hot: light-dark(#0b63ce, #7db7ff); --on-hot: light-dark(#fff, #0d1117); --good: light-dark(#0a7d4f, #5ee0a4); --near: light-dark(#fdfdfe, #363b46); --far: light-dark(#d9dee6, #14161b);
  position: relative; height: 100%; overflow: hidden; container-type: size; color-scheme: light dark; color: var(--ink); font: 14px/1.45 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; font-variant-numeric: tabular-nums; -webkit-text-size-adjust: 100%; }
.bsm[data-theme=light] { color-scheme: light; } .bsm[data-theme=dark] { color-scheme: dark; }
.bsm[data-back=white] { --near: #fff; --far: #fff; } .bsm[data-back=gray] { --near: #8b9099; --far: #8b9099; } .bsm[data-back=black] { --near: #000; --far: #000; }
.bsm *, .bsm ::before { box-sizing: border-box; }
.bsm [hidden] { display: none !important; }
.bsm :focus-visible { outline: 2px solid var(--hot); outline-offset: 2px; }
.bsm-stage { position: absolute; inset: 0; background: radial-gradient(circle at 50% 42%, var(--near), var(--far) 85%); }
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
.bsm-seg label small { display: block; font-size: 11.5px; opacity: .75; }
.bsm-seg label:has(:checked) { background: var(--hot); color: var(--on-hot); }
.bsm-seg label:has(:disabled) { opacity: .4; cursor: default; }
.bsm-seg select { border: 0; background: none; min-height: 36px; }
.bsm-seq { flex-basis: 100%; max-width: 46rem; display: grid; grid-template-columns: auto 1fr auto auto; gap: 12px; align-items: center; padding: 6px 14px 6px 6px; }
.bsm-seq button { width: 84px; background: var(--hot); color: var(--on-hot); border: 0; font-weight: 600; } .bsm-seq button:hover { color: var(--on-hot); }
.bsm kbd { font: inherit; font-weight: 600; color: var(--ink); border: 1px solid var(--line); border-radius: 5px; padding: 0 5px; } .bsm-seg:disabled { opacity: .45; }
.bsm-seq label { display: contents; } .bsm-seq .loop select { border: 0; background: none; padding: 0 4px; } .bsm-seq output { color: var(--soft); font-size: 13px; white-space: nowrap; }
.bsm-seq .loop { display: flex; gap: 6px; align-items: center; font-size: 13px; }
.bsm-scale { grid-area: 2 / 1; align-self: end; justify-self: start; padding: 10px 14px; font-size: 12px; width: 19rem; max-width: 100%; }
.bsm-scale div { height: 10px; border-radius: 5px; margin: 6px 0 3px; } .bsm-scale ol { display: flex; justify-content: space-between; list-style: none; margin: 0; padding: 0; } .bsm-scale li { display: grid; } .bsm-scale li:nth-child(2) { text-align: center; } .bsm-scale li:last-child { text-align: right; } .bsm-scale small { color: var(--soft); }
.bsm-wipe { position: absolute; inset: 0; width: 100% !important; height: 100%; margin: 0 !important; appearance: none; -webkit-appearance: none; background: none; pointer-events: none !important; outline: none; z-index: 0; }
.bsm-wipe::-webkit-slider-runnable-track { height: 100%; } .bsm-wipe::-moz-range-track { height: 100%; background: none; }
.bsm-wipe::-webkit-slider-thumb { -webkit-appearance: none; pointer-events: auto; width: 44px; height: 100cqh; cursor: ew-resize; background: radial-gradient(circle, #fff 13px, #0006 14px, #0000 15px) center 50% / 44px 44px no-repeat, linear-gradient(90deg, #0000 21px, #0005 21px, #fff 21.5px, #fff 22.5px, #0005 23px, #0000 23px); }
.bsm-wipe::-moz-range-thumb { pointer-events: auto; width: 44px; height: 100cqh; border: 0; border-radius: 0; cursor: ew-resize; background: radial-gradient(circle, #fff 13px, #0006 14px, #0000 15px) center 50% / 44px 44px no-repeat, linear-gradient(90deg, #0000 21px, #0005 21px, #fff 21.5px, #fff 22.5px, #0005 23px, #0000 23px); }
.bsm-wipe:focus-visible::-webkit-slider-thumb { filter: drop-shadow(0 0 4px var(--hot)); }
.bsm-tag { position: absolute; bottom: 78px; transform: translate(var(--shift), 0); --shift: -50%; pointer-events: none !important; background: var(--face); border: 1px solid var(--line); border-radius: 9px; padding: 3px 10px; font-size: 13px; font-weight: 600; white-space: nowrap; }
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
  .bsm:has([name=panel][aria-expanded=false]) .bsm-late { display: none; } .bsm-dock { gap: 6px; } .bsm-tag { bottom: 124px; }
  .bsm-seq { width: 100%; grid-template-columns: auto 1fr auto; } .bsm-seq .loop { grid-area: 2 / 3; } .bsm-seq output { grid-area: 2 / 1 / 3 / 3; white-space: normal; padding-left: 8px; } .bsm-seq input { grid-column: 2 / 4; } .bsm-scale { grid-area: 1 / 1; align-self: end; width: 14rem; padding: 6px 12px; }
  .bsm-seg label { padding: 4px 9px; } .bsm-panel { grid-area: 2 / 1 / 3 / 3; width: auto; max-height: 100%; margin: 0; align-self: end; }
}
</style>
<div class="bsm-stage"><canvas tabindex="0" role="img" aria-label="The mesh. Arrow keys turn it, plus and minus zoom."></canvas></div>
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
<label class="bsm-file" title="Open a mesh or stream"><input name="file" type="file" aria-label="Open a mesh or stream"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M12 16V4m-5 5 5-5 5 5M4 16v4h16v-4"/></svg></label>
<button name="picture" type="button" aria-label="Save a picture" title="Save a picture"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M4 8h3l2-3h6l2 3h3v11H4z"/><circle cx="12" cy="13" r="3.5"/></svg></button>
<button name="film" type="button" aria-label="Save a turntable" title="Save a turntable"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M20 12a8 8 0 1 1-3-6.2M20 3v5h-5"/></svg></button>
<button name="theme" type="button" aria-label="Dark or light" title="Dark or light"><svg viewBox="0 0 24 24" aria-hidden="true"><circle cx="12" cy="12" r="8"/><path d="M12 4v16a8 8 0 0 0 0-16z" fill="currentColor"/></svg></button>
<button name="keys" type="button" aria-expanded="false" aria-label="Keys" title="Keys (?)"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M8.5 9a3.5 3.5 0 1 1 5.2 3c-1.2.7-1.7 1.3-1.7 2.5"/><path d="M12 18v.01"/></svg></button>
<button name="panel" type="button" aria-expanded="false" aria-label="Settings" title="Settings"><svg viewBox="0 0 24 24" aria-hidden="true"><path d="M4 7h9m5 0h2M4 17h2m5 0h9"/><circle cx="15.5" cy="7" r="2.5"/><circle cx="8.5" cy="17" r="2.5"/></svg></button>
</div>
<p data-part="problem" role="alert"></p>
<div class="bsm-scale" data-part="scale" hidden><span data-part="legend"></span><div></div><ol></ol></div>
<div class="bsm-panel" data-part="panel" role="region" aria-label="Settings" hidden>
<section><h2>View</h2>
<label>Light from <input name="light" type="range" min="-180" max="180" value="0"></label>
<label class="row">Background <select name="back"><option value="">of the page</option><option value="white">white</option><option value="gray">gray</option><option value="black">black</option></select></label>
<label class="row">Turn by itself <input name="spin" type="checkbox"></label>
</section>
<section data-part="arrival"><h2>Arrival of the stream</h2>
<p data-part="status" role="status" aria-live="polite"></p>
<label>Cut the stream behind byte <input name="cut" type="range" min="0" max="1" value="1" step="1"><output data-part="bytes"></output></label>
<label class="row">Link, Mbit/s (0: as it comes) <input name="rate" type="number" min="0" step="any" value="0"></label>
<button name="again" type="button">Stream again</button>
<p data-part="times"></p>
</section>
<details><summary>Licenses</summary><pre data-part="licenses"></pre></details>
</div>
<div class="bsm-panel" data-part="keys" role="region" aria-label="Keys" hidden>
<section><h2>Keys</h2><dl>
<dt><kbd>1</kbd> <kbd>2</kbd> <kbd>3</kbd></dt><dd>choose a mesh</dd><dt><kbd>W</kbd></dt><dd>wipe, or one mesh</dd><dt><kbd>S</kbd></dt><dd>side by side, or one mesh</dd>
<dt><kbd>F</kbd></dt><dd>smooth, flat, wires</dd><dt><kbd>E</kbd></dt><dd>errors in colors</dd><dt><kbd>L</kbd></dt><dd>move the light</dd><dt><kbd>T</kbd></dt><dd>turn by itself</dd>
<dt><kbd>H</kbd></dt><dd>hide the controls, or show them</dd><dt><kbd>?</kbd></dt><dd>these keys</dd><dt>on the mesh</dt><dd>arrows turn, <kbd>+</kbd> and <kbd>-</kbd> zoom; drag, wheel, pinch</dd>
</dl></section>
</div>
<div class="bsm-dock">
<div class="bsm-seq" data-part="sequence" role="group" aria-label="Sequence" hidden>
<button name="play" type="button">Play</button>
<input name="frame" type="range" min="0" max="0" value="0" step="1" aria-label="Frame">
<output data-part="time"></output>
<span class="loop"><select name="speed" aria-label="Speed"><option value="0.25">¼ ×</option><option value="0.5">½ ×</option><option value="1" selected>1 ×</option><option value="2">2 ×</option></select><label><input name="loop" type="checkbox" checked> Loop</label></span>
</div>
<fieldset class="bsm-seg" data-part="layers" hidden><legend>Mesh</legend></fieldset>
<fieldset class="bsm-seg" data-part="modes" hidden><legend>Compare</legend>
<label><input type="radio" name="mode" value="one">Alone</label><label><input type="radio" name="mode" value="wipe">Wipe</label><label><input type="radio" name="mode" value="split">Side by side</label></fieldset>
<fieldset class="bsm-seg bsm-late"><legend>Shading</legend>
<label><input type="radio" name="shading" value="smooth" checked>Smooth</label><label><input type="radio" name="shading" value="flat">Flat</label><label><input type="radio" name="shading" value="wire">Wires</label></fieldset>
<div class="bsm-seg bsm-late" data-part="colors"><select name="color" aria-label="Color">
<option value="plain">Clay</option><option value="own">Own colors</option><option value="error">Error in colors</option><option value="blocks">Blocks</option><option value="refined">Refinement</option>
</select></div>
</div>
<div class="bsm-note" data-part="work" hidden><div><p data-part="stage" role="status"></p><progress max="1"></progress><button name="cancel" type="button">Cancel</button></div></div>
<div class="bsm-note" data-part="invite" hidden><div><p><b>Drop a mesh here</b>, or <label class="bsm-file" style="padding:2px 10px">open one<input name="file" type="file"></label></p><p>It is encoded on this machine; nothing leaves it.</p><label>Preset <select name="preset"><option>small</option><option selected>balanced</option><option>fine</option><option>near-lossless</option></select></label></div></div>
<div class="bsm-drop" data-part="drop" hidden>Drop it: nothing leaves this machine</div>
</form>
`;var _x=1e3,yx=12,Ef=["1","2","3"];function vx({center:i,scale:e,grid:t,lattice:n}){if(t.length===0)return{center:i,diagonal:e};let s=n.length>0?e*n[0]/n[1]:e;return{center:i.map((r,a)=>r+s*t[a]/2),diagonal:s*Math.max(Math.hypot(...t),1)}}var Dr=class{constructor(e,t,n,s){this.root=e;this.pool=t;this.encode=s;this.content={name:"",main:0,layers:[],facts:{}};this.stream=new Uint8Array(0);this.length=0;this.whole=!1;this.missed=0;this.geometry=new Wi;this.geometries=[];this.offs=[];this.dressed=new Set;this.fed=0;this.started=0;this.accompanied=!1;this.losses=[];this.over=!0;this.ended=!1;this.shown=!0;this.stale=!1;this.frameShown=-1;this.clock=0;this.before=0;this.closed=!1;this.choose=()=>this.restart();this.turns=0;this.watch=new ResizeObserver(()=>this.place());e.classList.add("bsm"),e.innerHTML=wf,[this.cut,this.rate,this.frame]=[this.control("cut"),this.control("rate"),this.control("frame")],[this.scheme,this.play]=[this.control("color"),this.control("play")],this.part("licenses").textContent=n,this.part("scale").querySelector("div").style.background=of;try{this.stage=new nl(e.querySelector("canvas"))}catch(a){throw this.fail(`This browser does not draw in three dimensions. ${a instanceof Error?a.message:a}`),a}this.listen(),this.watch.observe(e);let r=a=>{this.closed||(this.step(a),requestAnimationFrame(r))};requestAnimationFrame(r)}offer(e,t){let n=this.control("stream");this.choose=t,e.forEach((s,r)=>n.add(new Option(s,String(r)))),this.part("name").hidden=e.length>1,n.hidden=e.length<2,this.part("invite").hidden=e.length>0,e.length===0&&(this.root.dataset.state="empty")}turn(){let e=++this.turns;return()=>e===this.turns}open(e,t=-1){let n=this.control("stream");n.selectedIndex=t,this.part("name").hidden=t>=0&&n.length>1,this.content=e,[this.stream,this.length,this.whole]=[new Uint8Array(0),0,!1],this.cut.max=this.cut.value="0",[this.geometries,this.offs]=[[],[]],[this.alone,this.accompanied]=[void 0,!1],this.dressed.clear(),this.stage.clear(),this.part("name").textContent=e.name,this.part("invite").hidden=!0,this.part("arrival").hidden=this.part("colors").hidden=e.tiles!==void 0,this.list(),this.restart(),this.headline()}async openTiles(e,t){this.open(e,t),this.over=!0;let n=await il.open(e.tiles,this.pool,()=>this.looked="");if(this.closed||this.content!==e||this.tiles)return n.close();this.tiles=n}receive(e){let t=this.length+e.length;if(t>this.stream.length){let s=new Uint8Array(Math.max(t,2*this.stream.length));s.set(this.stream.subarray(0,this.length)),this.stream=s}this.stream.set(e,this.length);let n=this.cut.value===this.cut.max;this.length=t,this.cut.max=String(t),n&&(this.cut.value=this.cut.max)}finish(){this.whole=!0}fail(e){this.over=!0,this.complain(e),this.root.dataset.state="failed"}close(){this.closed=!0,this.watch.disconnect(),this.working?.abort(),this.decoding?.close(),this.tiles?.close(),this.stage.dispose()}control(e){return this.root.querySelector(`[name=${e}]`)}part(e){return this.root.querySelector(`[data-part=${e}]`)}complain(e){this.part("problem").textContent=e}listen(){let{root:e,stage:t}=this,n=(r,a,o)=>{for(let l of e.querySelectorAll(`[name=${r}]`))l.addEventListener(a,()=>o(l))};n("stream","change",({value:r})=>this.choose(Number(r))),n("mode","change",()=>this.compare()),n("shading","change",({value:r})=>t.shade(r)),n("color","change",()=>this.stale=!0),n("wipe","input",()=>this.compare()),n("light","input",({value:r})=>t.light=Number(r)),n("spin","change",({checked:r})=>t.spin=r),n("back","change",({value:r})=>e.dataset.back=r),n("again","click",()=>this.restart()),n("play","click",()=>this.toggle()),n("frame","input",({value:r})=>this.playback?.seek(Math.min(Number(r),this.geometry.frames.length-1))),n("loop","change",({checked:r})=>this.playback&&(this.playback.loop=r)),n("theme","click",()=>e.dataset.theme=this.isDark?"light":"dark");for(let r of["panel","keys"])n(r,"click",()=>this.unfold(r));n("picture","click",()=>this.stage.picture(...this.captions).toBlob(r=>r&&this.save(r,"png"))),n("film","click",r=>{this.film(r)}),n("cancel","click",()=>this.working?.abort()),n("file","change",r=>r.files?.[0]&&void this.take(r.files[0])),e.querySelector("form").addEventListener("submit",r=>r.preventDefault()),e.addEventListener("keydown",r=>this.key(r));let s=this.part("drop");e.addEventListener("dragover",r=>{r.preventDefault(),s.hidden=!1}),e.addEventListener("dragleave",r=>s.hidden=!r.relatedTarget||!e.contains(r.relatedTarget)),e.addEventListener("drop",r=>{r.preventDefault(),s.hidden=!0;let a=r.dataTransfer?.files[0];a&&this.take(a)}),matchMedia("(min-width: 45rem)").matches&&this.part("more").setAttribute("open","")}unfold(e){for(let t of["panel","keys"]){let n=t!==e||!this.part(t).hidden;this.part(t).hidden=n,this.control(t).setAttribute("aria-expanded",String(!n))}}key({key:e,target:t,ctrlKey:n,metaKey:s,altKey:r}){if(n||s||r||t.matches("select, [type=number]"))return;let a=e.toLowerCase(),o=(c,h)=>this.root.querySelector(`[name=${c}][value="${h}"]:not(:disabled)`)?.click(),l=(c,h)=>c[(c.indexOf(h)+1)%c.length];if(Ef.includes(a))o("layer",String(Ef.indexOf(a)));else if(a==="w"||a==="s")o("mode",this.stage.mode===(a==="w"?"wipe":"split")?"one":a==="w"?"wipe":"split");else if(a==="f")o("shading",l(["smooth","flat","wire"],this.picked("shading")));else if(a==="e")this.paint(this.scheme.value!=="error"?"error":this.dressed.size>0||this.geometry.colour?"own":"plain");else if(a==="t")this.control("spin").click();else if(a==="l"){let c=this.control("light");c.value=String((Number(c.value)+210)%360-180),this.stage.light=Number(c.value)}else a==="?"?this.unfold("keys"):a==="escape"?this.unfold(""):a==="h"&&this.root.toggleAttribute("data-bare")}paint(e){this.scheme.querySelector(`[value=${e}]`).disabled||(this.scheme.value=e),this.stale=!0}picked(e){return this.root.querySelector(`[name=${e}]:checked`)?.value??""}get isDark(){return this.root.dataset.theme?this.root.dataset.theme==="dark":matchMedia("(prefers-color-scheme: dark)").matches}allow(e,t){let n=this.scheme.querySelector(`[value=${e}]`);n.hidden=n.disabled=!t,n.selected&&!t&&(this.scheme.value="plain")}list(){let{layers:e,main:t}=this.content,n=this.part("layers");n.hidden=e.length<2,this.part("modes").hidden=e.length<2,n.replaceChildren(n.querySelector("legend")),e.forEach(({title:s,detail:r,size:a},o)=>{let l=Object.assign(document.createElement("input"),{type:"radio",name:"layer",value:String(o),disabled:o!==t,checked:o===t});l.addEventListener("change",()=>this.compare()),n.append(ii("label","",l,new Text(s),ii("small",`${kn(a)}${r?`, ${r}`:""}`)))}),this.root.querySelector("[name=mode][value=one]").checked=!0,this.allow("error",!1),this.compare()}async beside(e){let{layers:t,main:n}=e;if(this.accompanied=!0,t.length>1&&this.whole){let s=performance.now(),r=await sl(this.pool,this.stream.slice(0,this.length));this.alone=performance.now()-s,r.dispose(),this.content===e&&this.headline()}await this.dress(this.geometry,n);for(let[s,r]of t.entries()){let a=r.off&&new Float32Array((await oi(r.off)).buffer),o=s===n?void 0:await sl(this.pool,await oi(r));if(this.content!==e||this.closed)return;this.offs[s]=a,a&&this.allow("error",!0),this.stale=!0,o&&(this.geometries[s]=o,this.stage.show(s,o),await this.dress(o,s),this.recolor(),this.root.querySelector(`[name=layer][value="${s}"]`).disabled=!1,s===0&&this.root.querySelector("[name=mode][value=wipe]").click())}this.root.dataset.layers=String(t.length)}compare(){let{stage:e,content:t}=this,n=this.control("wipe"),s=Number(this.picked("layer")||t.main),r=this.picked("mode")||"one";this.part("modes").disabled=s===0&&t.main>0,e.mode=s===0?"one":r,e.sides=[0,s],e.wipe=Number(n.value)/Number(n.max),n.hidden=e.mode!=="wipe",e.mode==="split"&&this.part("more").removeAttribute("open"),this.place(),this.stale=!0}place(){let{stage:e}=this;e.fit();let[t,n]=this.captions[0],[s,r,a]=[this.root.clientWidth,e.seam,e.mode==="split"];for(let[o,l,c,h]of[["left",t,a?r/2:r-14,"-100%"],["right",n,a?(r+s)/2:r+14,"0%"]])this.say(o,e.mode==="one"?"":l),this.part(o).style.left=`${c}px`,this.part(o).style.setProperty("--shift",a?"-50%":h)}get captions(){let{layers:e}=this.content,t=getComputedStyle(this.root),n=document.createElement("i"),s=["--ink","--near","--far"].map(r=>{n.style.color=`var(${r})`,this.root.append(n);let{color:a}=getComputedStyle(n);return n.remove(),a||t.color});return[this.stage.sides.map(r=>e[r]?`${e[r].title}, ${kn(e[r].size||this.length)}`:""),s]}save(e,t){let n=Object.assign(document.createElement("a"),{href:URL.createObjectURL(e),download:`${this.content.name.replace(/\.\w+$/,"")||"mesh"}.${t}`});n.click(),setTimeout(()=>URL.revokeObjectURL(n.href),60*_x)}async film(e){e.disabled=!0;try{let t=await this.stage.film(...this.captions,n=>e.setAttribute("aria-label",`Save a turntable, ${Pr(n)}`));this.save(t,t.type.includes("mp4")?"mp4":"webm")}catch(t){this.complain(`This browser saves no films. ${t instanceof Error?t.message:t}`)}e.setAttribute("aria-label","Save a turntable"),e.disabled=!1}async take(e){this.working?.abort();let t=this.working=new AbortController;this.complain("");try{if(/\.bsm$/i.test(e.name)){let l=new Uint8Array(await e.arrayBuffer());return this.turn(),this.open({name:e.name,main:0,facts:{},layers:[{title:"BSM",detail:"",size:e.size}]}),this.receive(l),this.finish()}if(!this.encode)throw new Error(`This page has no encoder beside it, and shows .bsm alone. To see a mesh: bsm view ${e.name}`);[this.part("invite").hidden,this.part("work").hidden]=[!0,!1];let n=this.root.querySelector("progress"),s=this.control("preset").value,r=(l,c)=>{this.say("stage",`${e.name}: ${l}`),c>0?n.value=c:n.removeAttribute("value")};r("sending",0);let a=await this.encode(e,s,r,t.signal),o=await oi(a.layers[a.main]);if(this.working!==t||this.closed)return;this.turn(),this.open(a),this.receive(o),this.finish()}catch(n){t.signal.aborted||this.complain(`${e.name} cannot be shown. ${n instanceof Error?n.message:n}`)}finally{this.working===t&&(this.part("work").hidden=!0,this.part("invite").hidden=this.root.dataset.state!=="empty")}}walk(e){let{center:t,diagonal:n}=e.extent,{place:s,pixels:r}=this.stage.eye,a=[...s,r].join();if(a===this.looked)return;let o=this.looked===void 0;this.looked=a,o?this.stage.place(t,n):e.look(s,r);let l=e.shown;this.stage.together(l);let c=l.reduce((u,f)=>u+f.getIndex().count/3,0),{shards:h,levels:d}=e.manifest;this.say("figures",`${kn(h.reduce((u,{size:f})=>u+f,0))} in ${d.length} levels`),this.say("claim",`${kn(e.got)} fetched for this view`),this.listRows([["Shown",`${ni(c)} triangles in ${l.length} tiles`],["Fetched",`${ni(e.there)} tiles`]]),this.complain(e.problem),this.root.dataset.tiles=String(l.length),this.root.dataset.faces=String(c),this.root.dataset.state=e.complete?e.problem?"damaged":"complete":"loading",o?this.looked="":!this.shown&&l.length>0&&(this.shown=!0,this.stage.fill(l.map(u=>u.getAttribute("position").array)))}restart(){let{main:e}=this.content;this.decoding?.close(),this.tiles?.close(),this.tiles=this.looked=void 0;let t=new Wi({onConnectivity:()=>this.stale=!0,onBlock:()=>this.drawn(),onFrame:()=>this.begin(t)});this.geometry=this.geometries[e]=t,this.playback=void 0,this.fed=0,this.frameShown=-1,this.firstDrawn=this.completed=void 0,this.dressed.delete(e),this.dressed.size===0&&this.allow("own",!1),this.losses=[],this.missed=0,this.shown=this.over=this.ended=!1,this.started=performance.now(),this.complain(""),this.root.dataset.state="loading",this.decoding=this.pool.open({onPicture:n=>{t.accept(n),n.type==="loss"&&this.lose(n),n.type==="end"&&this.end()},onError:n=>this.fail(`This stream cannot be decoded further. ${n.name}: ${n.message}`),onTaken:n=>{this.root.dataset.taken=String(n),n===this.fed&&this.show()}},{tolerant:!0,drawing:"growing"})}step(e){if(this.stage.step(),this.playOn(e),this.stale&&this.recolor(),this.tiles)return this.walk(this.tiles);Number(this.cut.value)<this.fed&&this.restart();let t=this.allowed();!this.over&&this.fed<t&&(this.decoding?.receiveData(this.stream.subarray(this.fed,t)),this.fed=t),this.whole&&!this.ended&&this.fed===this.length&&(this.ended=!0,this.decoding?.receiveEof()),this.report()}allowed(){let e=Number(this.rate.value),t=e>0?e*(performance.now()-this.started)/.008:1/0;return Math.floor(Math.min(Number(this.cut.value),t))}show(){let{header:e,metadata:t}=this.geometry;if(this.shown||this.closed)return;this.shown=this.stale=!0;let{center:n,diagonal:s}=e?vx(e):{center:[0,0,0],diagonal:1};this.stage.show(this.content.main,this.geometry),this.stage.place(n,s,Gc(t))}lose(e){if(this.content.live&&e.frames?.first===0){this.missed=e.frames.count;return}this.losses.push(e);let t=this.losses.flatMap(({block:l})=>l===void 0?[]:[l]),n=this.losses.reduce((l,{frames:c})=>l+(c?.count??0),0),s=[t.length>0?`block${t.length>1?"s":""} ${t.join(", ")}`:"",n>0?`${n} frames`:""],{name:r,message:a}=qi(this.losses[0].error),o=s.filter(Boolean).join(" and ")||"some bytes";this.complain(`This stream is damaged: ${o} cannot be decoded, the rest is shown. First, ${r}: ${a}`)}drawn(){this.firstDrawn??=performance.now()-this.started,this.show(),this.stale=!0}end(){let{geometry:e,content:t}=this;this.over=!0,this.stale=!0,this.completed=performance.now()-this.started;let{frames:n}=e,s=Math.ceil(n.length/yx),r=n.length>0?n.filter((a,o)=>o%s===0).map(({positions:a})=>a):[e.getAttribute("position")?.array??[]];this.stage.fill(r,Gc(e.metadata),e.getAttribute("normal")),e.getIndex()&&this.stage.shadow(e),this.headline(),this.accompanied?this.dress(e,t.main):this.beside(t).catch(a=>this.complain(`Only the stream is shown. ${a instanceof Error?a.message:a}`)),this.root.dataset.state=this.losses.length>0?"damaged":"complete"}async dress(e,t){let n=[...e.metadata.keys()].some(s=>s.startsWith("material."));if(n){let s=await rf(e.metadata);if(e!==this.geometries[t]||this.closed)return;let r=af(e.metadata,s,1+Math.max(0,...e.pieces.map(({material:a})=>a)));for(let a of r)a.vertexColors=e.colour!==void 0;this.stage.dress(t,r),this.dressed.add(t)}!n&&!e.colour||(this.allow("own",!0),this.scheme.value==="plain"&&(this.scheme.value="own"),this.stale=!0)}begin(e){this.playback??=new jo(e.frameRate,!matchMedia("(prefers-reduced-motion: reduce)").matches),this.playback.loop=this.control("loop").checked}toggle(){let{playback:e,geometry:t,over:n}=this;e&&(e.playing=!e.playing,e.playing&&n&&e.frame===t.frames.length-1&&e.seek(0),this.label(e))}label({playing:e}){this.play.textContent=e?"Pause":"Play"}playOn(e){let{playback:t,geometry:n,missed:s}=this;if(this.part("sequence").hidden=!t,!t)return;let r=n.frames.length;this.clock+=(e-this.before)*Number(this.control("speed").value),this.before=e,t.step(this.clock,r,this.over),t.frame!==this.frameShown&&(this.frameShown=t.frame,n.showFrame(this.frameShown),this.over&&this.stage.shadow(n),this.stale=!0);let a=Math.max(n.header.frames-s,r);this.root.dataset.frame=String(this.frameShown),this.root.dataset.there=String(r),this.frame.max=String(a-1),this.frame.value=String(this.frameShown),this.label(t);let o=r<a?`, ${r} are there`:"",l=`${s+this.frameShown+1} of ${s+a}`,c=this.over&&a>0?`; ${kn(Math.round(this.length/a))} a frame`:"";this.say("time",`${l}${o}; ${((s+this.frameShown)/t.rate).toFixed(2)} s${c}`),this.frame.setAttribute("aria-valuetext",`frame ${l}`)}recolor(){let{content:e,geometries:t,offs:n,stage:s}=this,r=e.tiles===void 0?this.scheme.value:"plain";this.stale=!1;let{diagonal:a=1}=e.facts,o=a*lf(n[e.main]??[0],a);t.forEach((h,d)=>{if(!h||d===e.main&&!this.shown)return;let u=r==="own",f=cf(h,r,n[d],o);s.color(d,u?h.colour:f&&new bt(f,3),u&&this.dressed.has(d))}),this.part("scale").hidden=Hc[r]==="",this.say("legend",Hc[r]);let l=this.geometry.metadata.get("unit"),c=r==="error"?[0,.5,1].map(h=>[`${Pr(h*o/a)}`,`${Number((h*o).toPrecision(2))} ${typeof l=="string"?l:""}`]):r==="blocks"?[["first"],["last"]]:[["not"],["refined"]];this.part("scale").querySelector("ol").replaceChildren(...c.map(([h,d])=>ii("li",h,...d?[ii("small",d)]:[])))}headline(){let{content:e,geometry:t,length:n,alone:s,completed:r}=this;if(e.tiles)return;let{plain:a,size:o,claim:l,rows:c}=uf(e,n,t.frames.length,t.header,s??r);this.part("figures").replaceChildren(...t.header||e.main>0?[ii("s",`${kn(a)} → `)]:[],o>0?kn(o):""),this.say("claim",l),this.listRows(c)}listRows(e){this.part("more").hidden=e.length===0,this.part("facts").replaceChildren(...e.flatMap(([t,n,s])=>[ii("dt",t),ii("dd",n,...s?[ii("small",` ${s}`)]:[])]))}report(){let{fed:e,geometry:t,length:n,root:s}=this,r=n?Math.round(100*e/n):0;this.say("bytes",`${ni(e)} of ${ni(n)} bytes (${r} %)${this.whole?"":", more are to come"}`),this.say("status",this.statusText());let a=[["first faces",this.firstDrawn],["complete",this.completed]];this.say("times",a.flatMap(([o,l])=>l===void 0?[]:[`${o} after ${Jo(l)}`]).join("; ")),s.dataset.blocks=String(t.blocks)}statusText(){let{header:e,blocks:t,refinedVertices:n}=this.geometry;if(!e)return"";let s=e.blocks?`${t} of ${e.blocks} blocks`:`${t} chunks of a grid`,r=e.refinement.length>0?`, ${Math.floor(100*n/e.vertices)} % refined`:"",a=this.missed>0?`, entered at frame ${this.missed+1}`:"",o=e.gopFrames>0?`, ${e.frames||"any number of"} frames${a}`:"",l=e.attributes>0?`, ${this.geometry.carried.length} of ${e.attributes} attributes`:"";return`${s}${r}, ${ni(e.vertices)} vertices${o}${l}`}say(e,t){let n=this.part(e);n.textContent!==t&&(n.textContent=t)}};var Af=2**26;async function*Rf({body:i}){let e=i.getReader();try{for(let t;!(t=await e.read()).done;)yield t.value}finally{e.cancel().catch(()=>{})}}var xx=async(i,e,t,n)=>{if(i.size>Af)throw new Error(`It has more than ${Af>>20} MiB; use bsm encode, or bsm tile.`);let s=new URLSearchParams({name:i.name,preset:e}),r=new TextDecoder,a="";for await(let o of Rf(await ca(`upload?${s}`,{method:"POST",body:i,signal:n}))){a+=r.decode(o,{stream:!0});for(let l;(l=a.indexOf(`
`))>=0;a=a.slice(l+1)){let{stage:c,share:h,error:d,entry:u}=JSON.parse(a.slice(0,l));if(d)throw new Error(d);if(u)return u;t(c,h)}}throw new Error("The server has stopped.")};async function bx(i){let e=JSON.parse(i.textContent),t=new Gs(El),n=new Dr(document.body,t,`three

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
SOFTWARE.`,uu?xx:void 0),s=async r=>{let a=n.turn(),o=e[r];try{if(await t.preload().catch(()=>{}),!a())return;if(o.tiles!==void 0)return await n.openTiles(o,r);let{url:l}=o.layers[o.main],c=l===void 0?[await oi(o.layers[o.main])]:Rf(await ca(l));a()&&n.open(o,r);for await(let h of c){if(!a())return;n.receive(h)}a()&&n.finish()}catch(l){a()&&n.fail(`${o.name} could not be fetched. ${l instanceof Error?l.message:l}`)}};n.offer(e.map(({name:r})=>r),s),e.length>0&&await s(0)}async function Mx({model:i,el:e}){let t=e.appendChild(document.createElement("div"));t.style.height=`${i.get("height")}px`;let n=new Dr(t,new Gs(El),`three

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
SOFTWARE.`),s=async()=>{let r=i.get("content");n.open(r),n.receive(await oi(r.layers[r.main])),n.finish()};return i.on("change:content",s),await s(),()=>{i.off("change:content",s),n.close()}}var uT={render:Mx},Tf=document.getElementById("bsm-streams");Tf&&bx(Tf);export{uT as default};
