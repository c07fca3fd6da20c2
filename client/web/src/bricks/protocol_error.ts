/** The server contradicts itself or this version. */
export class ProtocolError extends Error {
  override name = 'ProtocolError';
}
