// A sequence in an element of its own; without a line of program: <bsm-player src="/wave.bsm" autoplay loop></bsm-player>
import { BSMPlayer } from "bsm-decoder/player";

const player = new BSMPlayer();
player.style.height = "100%";
player.style.background = "black";
player.src = "/wave.bsm";
player.loop = true;
player.setAttribute("autoplay", "");

player.addEventListener("loop", () => console.log("again"));
player.addEventListener("load", () => (document.title = "loaded"));
player.addEventListener("error", (event) => console.error(event.error));
player.addEventListener("click", () => (player.paused ? player.play() : player.pause()));
document.getElementById("root")!.append(player);
