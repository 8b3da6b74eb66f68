// Stands in for the WebSocket of the page of `stream --to web`: gives it the pictures of RECORDING again and again.
// replay.py writes RECORDING before these lines.
"use strict";
window.WebSocket = class {
  static OPEN = 1;
  readyState = 0;
  state = "recorded";
  #pictures = [];
  #sent = -1;
  #start = 0;

  constructor() { this.#open(); }

  async #open() {
    const packed = new Blob([Uint8Array.from(atob(RECORDING.pictures), letter => letter.charCodeAt())]);
    const bytes = await new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
    for (let at = 0; at < bytes.byteLength;) {
      const [planes, text] = new Uint32Array(bytes.slice(at, at + 8)), end = at + 8 + planes;
      this.#pictures.push({planes: bytes.slice(at + 8, end), json: JSON.parse(new TextDecoder().decode(bytes.slice(end, end + text)))});
      at = end + text;
    }
    this.readyState = 1;
    this.#start = performance.now();
    this.onopen();
    this.onmessage({data: await new Blob([new Uint32Array([1]), JSON.stringify(RECORDING.health)]).arrayBuffer()});
  }

  // "next": the next picture, at its time. Numbers and times of frames go on from round to round.
  send() {
    const interval = 1000 / RECORDING.rate_hz, sequence = Math.max(this.#sent + 1, Math.floor((performance.now() - this.#start) / interval));
    this.#sent = sequence;
    const {planes, json} = this.#pictures[sequence % this.#pictures.length];
    const text = JSON.stringify({...json, sequence, time: sequence / RECORDING.rate_hz});
    setTimeout(async () => this.onmessage({data: await new Blob([planes, text]).arrayBuffer()}),
               this.#start + sequence * interval - performance.now());
  }
};
