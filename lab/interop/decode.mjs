// Decodes messages with the readers of Foxglove, and prints one line of JSON for each:
//   node decode.mjs stream FILE.mcap            @mcap/core, front to back
//   node decode.mjs index FILE.mcap             @mcap/core, by the index
//   node decode.mjs serve PORT SUBPROTOCOL      @foxglove/ws-protocol, until the server closes
// Bytes are in base64.
import {readFileSync} from "node:fs";
import rosmsg from "@foxglove/rosmsg";
import serialization from "@foxglove/rosmsg2-serialization";
import protocol from "@foxglove/ws-protocol";
import {McapIndexedReader, McapStreamReader} from "@mcap/core";
import {loadDecompressHandlers} from "@mcap/support";
import WebSocket from "ws";

const readers = new Map(); // by topic

function addReader(topic, schema) {
  if (readers.has(topic)) return;
  const definitions = rosmsg.parse(schema, {ros2: true});
  readers.set(topic, new serialization.MessageReader(definitions, {timeType: "sec,nanosec"}));
}

function plain(name, value) {
  if (typeof value === "bigint") return value.toString();
  if (ArrayBuffer.isView(value)) {
    return {base64: Buffer.from(value.buffer, value.byteOffset, value.byteLength).toString("base64")};
  }
  return value;
}

function print(topic, time, sequence, data) {
  const reader = readers.get(topic);
  const message = reader.readMessage(data);
  if (reader.lastReadHadTrailingBytes()) throw new Error(`${topic}: bytes are left`);
  console.log(JSON.stringify({topic, time, sequence, message}, plain));
}

async function readStream(file) {
  const reader = new McapStreamReader({
    validateCrcs: true,
    decompressHandlers: await loadDecompressHandlers(),
  });
  const schemas = new Map();
  const topics = new Map();
  const bytes = readFileSync(file);
  const step = 100_000; // Records are cut at any place.
  for (let at = 0; at < bytes.length; at += step) {
    reader.append(bytes.subarray(at, at + step));
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type === "Schema") schemas.set(record.id, new TextDecoder().decode(record.data));
      if (record.type === "Channel") {
        topics.set(record.id, record.topic);
        addReader(record.topic, schemas.get(record.schemaId));
      }
      if (record.type === "Message") {
        print(topics.get(record.channelId), record.logTime, record.sequence, record.data);
      }
    }
  }
  if (!reader.done()) throw new Error("the file has no end");
}

async function readIndex(file) {
  const bytes = readFileSync(file);
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
    },
    decompressHandlers: await loadDecompressHandlers(),
  });
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    addReader(channel.topic, new TextDecoder().decode(schema.data));
  }
  for await (const message of reader.readMessages({validateCrcs: true})) {
    const {topic} = reader.channelsById.get(message.channelId);
    print(topic, message.logTime, message.sequence, message.data);
  }
}

async function readServer(port, subprotocol) {
  const socket = new WebSocket(`ws://127.0.0.1:${port}`, [subprotocol]);
  const client = new protocol.FoxgloveClient({ws: socket});
  const topics = new Map();
  client.on("advertise", (channels) => {
    for (const channel of channels) {
      addReader(channel.topic, channel.schema);
      topics.set(client.subscribe(channel.id), channel.topic);
    }
  });
  client.on("message", ({subscriptionId, timestamp, data}) => {
    print(topics.get(subscriptionId), timestamp, 0, data);
  });
  client.on("status", (status) => console.error(status.message));
  await new Promise((resolve) => client.on("close", resolve));
  if (socket.protocol !== subprotocol) throw new Error(`the server chose ${socket.protocol}`);
}

const [way, ...rest] = process.argv.slice(2);
await {stream: readStream, index: readIndex, serve: readServer}[way](...rest);
