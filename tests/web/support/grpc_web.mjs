// Answers of a server, made up: what a real one never sends, or not when a test needs it.

/** A protobuf message of [number, value]: numbers are varints, text and bytes have their length. */
export function protobuf(...fields) {
  return Buffer.concat(
    fields.map(([number, value]) => {
      if (typeof value === 'number') return Buffer.concat([varint(number * 8), varint(value)]);
      const bytes = Buffer.from(value);
      return Buffer.concat([varint(number * 8 + 2), varint(bytes.length), bytes]);
    }),
  );
}

function varint(value) {
  const bytes = [];
  for (; value >= 128; value = Math.floor(value / 128)) bytes.push((value % 128) + 128);
  return Buffer.from([...bytes, value]);
}

/** The response with which page.route() fulfills a call. */
export function answer(message) {
  const framed = (flags, data) => {
    const header = Buffer.alloc(5);
    header.writeUInt8(flags);
    header.writeUInt32BE(data.length, 1);
    return Buffer.concat([header, data]);
  };
  return {
    contentType: 'application/grpc-web+proto',
    body: Buffer.concat([framed(0, message), framed(0x80, Buffer.from('grpc-status:0\r\n'))]),
  };
}
