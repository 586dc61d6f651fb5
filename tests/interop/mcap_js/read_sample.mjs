// SPDX-License-Identifier: Apache-2.0
//
// node read_sample.mjs FOLDER: reads the recordings of write_sample with the format's own JavaScript
// library, every CRC checked, and decodes their messages by nothing but the schemas in them.

import { strict as assert } from "node:assert";
import { open, readFile } from "node:fs/promises";
import { join } from "node:path";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { decompress } from "fzstd";

const PACKETS = 300;
const CHANNELS = 14;
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };
const text = new TextDecoder();

/// Decodes what one channel carries.
function decoder(schema) {
    assert.equal(schema.encoding, "omgidl");
    return new MessageReader(schema.name, parseIDL(text.decode(schema.data)));
}

function checkMessage(topic, message, decoded) {
    const i = message.sequence;
    if (topic === "pursuit/events") {
        assert.equal(message.logTime - message.publishTime, 100n);
        assert.equal(decoded.sequence_number, BigInt(i));
        assert.equal(decoded.stream_id, 0x1122334455667788n);
        assert.equal(decoded.width, 304);
        assert.equal(decoded.words.length, 100);
        assert.equal(decoded.words[7], (7n << 32n) | (17n << 16n) | (27n << 1n) | 1n);
    } else if (topic === "pursuit/poses") {
        assert.equal(decoded.model, "car");
        assert.equal(decoded.transform, 2);
        assert.equal(decoded.state, 2);
        assert.equal(decoded.x_px, 0.5 * i);
        assert.equal(decoded.y_px, -1.25);
        assert.equal(decoded.pose_covariance[20], 42);
        assert.equal(decoded.events_used, 9007199254740993n);
    } else {
        assert.equal(topic, "pursuit/tracker/reply");
        assert.equal(decoded.outcome.message, "done");
        const model = decoded.result.get_model;
        assert.equal(model.name, "van");
        assert.deepEqual({ ...model.points[4] }, { x_px: -3.5, y_px: 2.25 });
    }
}

/// Front to back, as a viewer reads a stream.
async function stream(path) {
    const reader = new McapStreamReader({
        decompressHandlers,
        validateCrcs: true,
        includeChunks: true,
    });
    reader.append(await readFile(path));
    const schemas = new Map();
    const channels = new Map();
    const counts = { Message: 0, Metadata: 0, Chunk: 0 };
    for (let record; (record = reader.nextRecord()); ) {
        counts[record.type] = (counts[record.type] ?? 0) + 1;
        if (record.type === "Schema") schemas.set(record.id, decoder(record));
        if (record.type === "Channel") channels.set(record.id, record);
        if (record.type === "Message") {
            const channel = channels.get(record.channelId);
            assert.equal(channel.messageEncoding, "cdr");
            assert.equal(channel.metadata.get("pursuit.partitions"), "\nfront\n");
            const decoded = schemas.get(channel.schemaId).readMessage(record.data);
            checkMessage(channel.topic, record, decoded);
        }
    }
    assert.equal(counts.Message, 2 * PACKETS + 1);
    assert.equal(counts.Metadata, 1);
    assert.equal(channels.size, CHANNELS);
    return { counts, done: reader.done() };
}

/// By the summary, as a viewer seeks.
async function indexed(path) {
    const file = await open(path);
    const readable = {
        size: async () => BigInt((await file.stat()).size),
        read: async (offset, length) => {
            const buffer = new Uint8Array(Number(length));
            await file.read(buffer, 0, Number(length), Number(offset));
            return buffer;
        },
    };
    const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
    assert.equal(reader.statistics.messageCount, BigInt(2 * PACKETS + 1));
    assert.equal(reader.channelsById.size, CHANNELS);
    assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
    let messages = 0;
    let last = 0n;
    for await (const message of reader.readMessages({ validateCrcs: true })) {
        assert.ok(message.logTime >= last, "not in order of log time");
        last = message.logTime;
        ++messages;
    }
    assert.equal(messages, 2 * PACKETS + 1);
    let replies = 0;
    for await (const message of reader.readMessages({ topics: ["pursuit/tracker/reply"] })) {
        replies += message.sequence;
    }
    assert.equal(replies, 1);
    const metadata = [];
    for await (const record of reader.readMetadata({ name: "pursuit.session" })) metadata.push(record);
    assert.equal(metadata[0].metadata.get("host"), "here");
    await file.close();
    return reader.chunkIndexes.length;
}

const folder = process.argv[2];
let passed = 0;
let failed = 0;
async function test(name, run) {
    try {
        console.log(`ok      ${name}: ${await run()}`);
        ++passed;
    } catch (error) {
        console.log(`FAILED  ${name}: ${error.stack}`);
        ++failed;
    }
}

for (const name of ["closed_zstd.mcap", "closed_none.mcap", "killed.mcap"]) {
    await test(`${name} streamed`, async () => {
        const { counts, done } = await stream(join(folder, name));
        assert.equal(done, name !== "killed.mcap");
        return `${counts.Message} messages in ${counts.Chunk} chunks`;
    });
}
for (const name of ["closed_zstd.mcap", "closed_none.mcap"]) {
    await test(`${name} by its index`, async () => `${await indexed(join(folder, name))} chunks`);
}
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed === 0 ? 0 : 1);
