use fidelity::*;
fn main(){
 let cases=cases::all(); let stress=cases::stress(0);
 let which: Vec<String>=std::env::args().skip(1).collect();
 let mut out=vec![];
 for w in &which { let e= if w=="rapier"{Engine::Rapier}else{Engine::Batched};
  let t=Traces::of(e,w,&cases,&stress); 
  if w=="batched" { let s=&t.coarse[3]; for i in [0,20,50,100,200,400,800,1999]{ eprintln!("{} pos {:?} feet {:?} f {}",i,s.frames[i].position,s.frames[i].feet(),s.frames[i].force);} 
   let truth=engines::reference(&cases[0]); let mut bad=0; for f in &truth.frames { for (j,q) in g1::JOINT_TABLE.iter().zip(f.joints){ if (q as f64)<j.lower||(q as f64)>j.upper{ bad+=1; eprintln!("out {} {}",j.name,q);} } } eprintln!("out {bad}");
  }
  out.push((w.as_str(),rows(&t))); }
 println!("{}",markdown(&out));
}
