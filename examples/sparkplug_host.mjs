// A host of Sparkplug B in JavaScript: prints what StatorWatch's edge node tells, and has it born again at the start.
//
//   npm install mqtt sparkplug-payload
//   node sparkplug_host.mjs mqtt://127.0.0.1:1883 StatorWatch/statorwatch
import mqtt from "mqtt";
import payloads from "sparkplug-payload";

const sparkplug = payloads.get("spBv1.0");
const [url = "mqtt://127.0.0.1:1883", node = "StatorWatch/statorwatch"] = process.argv.slice(2);
const [group, edgeNode] = node.split("/");
const client = await mqtt.connectAsync(url);

client.on("message", (topic, bytes) => {
  if (topic.split("/")[2] === "NCMD") return;
  const told = sparkplug.decodePayload(bytes);
  console.log(`${topic}  seq ${told.seq ?? "-"}, ${told.metrics.length} metrics`);
  for (const metric of told.metrics) {
    const quality = metric.properties?.Quality ? `  quality ${metric.properties.Quality.value}` : "";
    const time = new Date(Number(metric.timestamp)).toISOString();
    console.log(`  ${metric.name.padEnd(26)} ${metric.type.padEnd(9)} ${metric.value}  at ${time}${quality}`);
  }
});
await client.subscribeAsync(`spBv1.0/${group}/#`, { qos: 1 });

const rebirth = { name: "Node Control/Rebirth", type: "Boolean", value: true };
const command = sparkplug.encodePayload({ timestamp: Date.now(), metrics: [rebirth] });
await client.publishAsync(`spBv1.0/${group}/NCMD/${edgeNode}`, command, { qos: 1 });
