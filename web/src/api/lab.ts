/** Every request that the pages make, one function each. */
import { readMethods, readPlots, readVersions } from './analysis';
import { base, query, request } from './client';
import { readCheck, readDefinition, type ExperimentDefinition } from './experiment';
import { record, type Json } from './json';
import type { Booking, CreatedUser, FieldError, LiveTicket, NewBooking, NewUser, Result, Rig, Run, RunPage, Session, User } from './types';

const id = encodeURIComponent;

export const signIn = (username: string, password: string) => request<Session>('POST', '/session', { username, password });
export const currentSession = () => request<Session>('GET', '/session');
export const signOut = () => request<void>('DELETE', '/session');
export const changePassword = (current: string, next: string) => request<Session>('PUT', '/session/password', { current, new: next });

export const users = async () => (await request<{ users: User[] }>('GET', '/users')).users;
export const addUser = (user: NewUser) => request<CreatedUser>('POST', '/users', user);

export const rigs = async () => (await request<{ rigs: Rig[] }>('GET', '/rigs')).rigs;
export const rig = (rigId: string) => request<Rig>('GET', `/rigs/${id(rigId)}`);
export const cameraUrl = (rigId: string) => `${base}/rigs/${id(rigId)}/camera.jpg`;
export const liveTicket = (rigId: string) => request<LiveTicket>('POST', `/rigs/${id(rigId)}/live-ticket`);
export const liveUrl = (rigId: string, ticket: string) => `${base}/rigs/${id(rigId)}/live?ticket=${id(ticket)}`;

export const experiment = async (name: string): Promise<ExperimentDefinition> =>
  readDefinition(name, await request<unknown>('GET', `/experiments/${id(name)}`));

export const experiments = async (): Promise<ExperimentDefinition[]> =>
  (await request<{ experiments: unknown[] }>('GET', '/experiments')).experiments.map((e) => readDefinition('', e));
export const createExperiment = async (definition: Json) => readDefinition('', await request<unknown>('POST', '/experiments', { definition }));
export const changeExperiment = async (name: string, definition: Json) =>
  readDefinition(name, await request<unknown>('PUT', `/experiments/${id(name)}`, { definition }));
export const publishExperiment = (name: string) => request<unknown>('POST', `/experiments/${id(name)}/publish`);
export const retireExperiment = (name: string) => request<void>('DELETE', `/experiments/${id(name)}`);
/** What is wrong with a definition, and where; null if nothing is. */
export const checkExperiment = async (definition: Json): Promise<FieldError | null> =>
  readCheck(await request<unknown>('POST', '/experiments/check', { definition }));
export const tryExperiment = async (definition: Json, runId: number) => {
  const answer = record(await request<unknown>('POST', '/experiments/try', { definition, run: runId }));
  return { result: answer['result'] as Result, plots: readPlots(answer) };
};
export const analyses = async () => readMethods(await request<unknown>('GET', '/analyses'));

export const myBookings = async () => (await request<{ bookings: Booking[] }>('GET', '/bookings')).bookings;
export const rigBookings = async (rigId: string, from: Date, to: Date) =>
  (await request<{ bookings: Booking[] }>('GET', `/rigs/${id(rigId)}/bookings${query({ from: wireTime(from), to: wireTime(to) })}`)).bookings;
export const book = (booking: NewBooking) => request<Booking>('POST', '/bookings', booking);
export const cancelBooking = (bookingId: number) => request<void>('DELETE', `/bookings/${bookingId}`);

export const prepareRun = (rigId: string, experimentId: string, parameters: Record<string, number>) =>
  request<Run>('POST', '/runs', { rig: rigId, experiment: experimentId, parameters });
export const runs = (filter: { limit?: number; before?: number | undefined; rig?: string; mine?: boolean }) =>
  request<RunPage>('GET', `/runs${query(filter)}`);
export const run = (runId: number) => request<Run>('GET', `/runs/${runId}`);
export const commandRun = (runId: number, command: 'release' | 'stop' | 'abort') => request<Run>('POST', `/runs/${runId}/${command}`);
export const plots = async (runId: number, version?: number) => readPlots(await request<unknown>('GET', `/runs/${runId}/plots${query({ version })}`));
export const results = async (runId: number) => readVersions(await request<unknown>('GET', `/runs/${runId}/results`));
export const analyseAgain = (runId: number, settings: Record<string, number | null>) =>
  request<unknown>('POST', `/runs/${runId}/results`, { settings });
export const plotUrl = (runId: number, name: string, format: 'svg' | 'png', version?: number) =>
  `${base}/runs/${runId}/plots/${id(name)}.${format}${query({ version })}`;
export const reportUrl = (runId: number, version?: number) => `${base}/runs/${runId}/report${query({ version })}`;
export const posesCsvUrl = (runId: number) => `${base}/runs/${runId}/poses.csv`;

/** Whole seconds in UTC, as the interface writes them. */
export function wireTime(time: Date | number): string {
  return new Date(time).toISOString().replace(/\.\d+Z$/, 'Z');
}
