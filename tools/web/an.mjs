import { build } from "esbuild";import {brotliCompressSync as br} from "node:zlib";
const o={entryPoints:["src/index.ts"],bundle:true,minify:true,format:"esm",target:"es2022",charset:"utf8",metafile:true,write:false,legalComments:"none"};
const r=await build(o);
const m=Object.values(r.metafile.outputs)[0];
console.log(Object.entries(m.inputs).map(([k,v])=>k+" "+v.bytesInOutput).join("\n"),br(r.outputFiles[0].contents).length);
for(const f of ["src/sequence.ts","src/tolerant.ts","src/zstd.ts","src/inflate.ts","src/header.ts","src/errors.ts"]){
 const r2=await build({...o,plugins:[{name:"x",setup(b){b.onLoad({filter:new RegExp(f.replace("src/",""))},()=>({contents:"export const Sequence=0,TolerantReader=0,unpackZstd=0,inflate=0,parseHeader=0,BsmError=0,CorruptError=0,UnsupportedError=0,LimitError=0,NumericError=0,TruncatedError=0,FormatError=0,errorLike=0",loader:"js"}))}}]});
 console.log("without",f,br(r2.outputFiles[0].contents).length)}
let t=r.outputFiles[0].text;
console.log("strings", br(t.replace(/`[^`]*`/g,'``').replace(/"[^"]*"/g,'""')).length);
