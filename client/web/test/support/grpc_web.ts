// Answers of a server, as gRPC-Web has them.
export const grpcWeb = { 'content-type': 'application/grpc-web+proto' };

export function message(flags: number, data: Uint8Array): Uint8Array {
  const framed = new Uint8Array(5 + data.length);
  framed[0] = flags;
  new DataView(framed.buffer).setUint32(1, data.length);
  framed.set(data, 5);
  return framed;
}

export function trailers(text: string): Uint8Array {
  return message(0x80, new TextEncoder().encode(text));
}

export function body(...parts: Uint8Array[]): Response {
  const bytes = parts.flatMap((part) => [...part]);
  return new Response(Uint8Array.from(bytes), { headers: grpcWeb });
}
