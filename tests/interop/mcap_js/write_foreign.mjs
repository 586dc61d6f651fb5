// SPDX-License-Identifier: Apache-2.0
//
// node write_foreign.mjs FOLDER: writes foreign_chunked.mcap and foreign_plain.mcap with the MCAP
// project's library: 500 messages of two channels, log times out of order, metadata and an attachment.

import { open } from "node:fs/promises";
import { join } from "node:path";
import { McapWriter } from "@mcap/core";

for (const useChunks of [true, false]) {
    const name = `foreign_${useChunks ? "chunked" : "plain"}.mcap`;
    const file = await open(join(process.argv[2], name), "w");
    let size = 0n;
    const writable = {
        position: () => size,
        write: async (data) => {
            await file.write(data);
            size += BigInt(data.byteLength);
        },
    };
    const writer = new McapWriter({ writable, useChunks, chunkSize: 4096 });
    await writer.start({ profile: "", library: "foreign" });
    const data = new TextEncoder().encode("struct S { long a; };");
    const schemaId = await writer.registerSchema({ name: "S", encoding: "omgidl", data });
    const channels = [];
    for (const topic of ["a", "b"]) {
        const metadata = new Map([["k", "v"]]);
        channels.push(
            await writer.registerChannel({ schemaId, topic, messageEncoding: "cdr", metadata }),
        );
    }
    await writer.addMetadata({ name: "m", metadata: new Map([["k", "v"]]) });
    for (let i = 0; i < 500; ++i) {
        const logTime = BigInt(1000 + i + (i % 7) * 3);
        await writer.addMessage({
            channelId: channels[i % 2],
            sequence: i,
            logTime,
            publishTime: logTime,
            data: new Uint8Array([0, 1, 0, 0, i & 255, i >> 8, 0, 0]),
        });
    }
    await writer.addAttachment({
        logTime: 1n,
        createTime: 1n,
        name: "note.txt",
        mediaType: "text/plain",
        data: new TextEncoder().encode("hello"),
    });
    await writer.end();
    await file.close();
}
